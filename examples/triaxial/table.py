# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints what triaxial tests of grains and of spheres found, as a table.

usage: table.py WORK
WORK holds runs sand-KPA and spheres-KPA, and beside each what `reckon run RUN.toml --resume --json` says of it, RUN.json.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves

# Rows that are averaged where friction angles are read off a curve.
WINDOW = 5


def smoothed(values: np.ndarray) -> np.ndarray:
    return np.convolve(values, np.ones(WINDOW) / WINDOW, mode="valid")


def figures(run: Path, kpa: int) -> list[str]:
    """A column of the table."""
    answer = curves.answer(run)
    shear = answer["driven_stages"][-1]
    rows = curves.last_stage(run)
    cell = 1000.0 * kpa
    stress = rows["wall_stress_zz_Pa"]
    by_cell = np.degrees(np.arcsin((stress - cell) / (stress + cell)))
    return [
        f"{rows['void_ratio'][0]:.3f}",
        f"{shear['peak_friction_angle_deg']:.1f}° at {100 * shear['strain_at_peak']:.1f} %",
        f"{shear['dilatancy_angle_deg']:.1f}°",
        f"{curves.late_friction_angle(rows):.1f}°",
        f"{rows['void_ratio'][-1]:.3f}",
        f"{smoothed(by_cell).max():.1f}°",
        f"{100 * shear['stress_disagreement']:.2f} % ({100 * shear['largest_stress_disagreement']:.1f} %)",
        f"{curves.energy_error_percent(answer):.2f} %",
    ]


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    work = Path(sys.argv[1])
    tests = [(kind, kpa) for kind in ("sand", "spheres") for kpa in (50, 100, 200)]
    names = [
        "void ratio in the membrane, before shearing",
        "peak friction angle, at axial strain",
        "dilatancy angle at the peak",
        "friction angle over the last fifth",
        "void ratio at 15 % strain",
        "peak with the cell pressure for σ₃",
        "difference of stress by contacts and by walls and membrane, median row (max)",
        "energy balance error of the whole test, of the energy turned over",
    ]
    columns = [figures(work / f"{kind}-{kpa}", kpa) for kind, kpa in tests]
    print("| | " + " | ".join(f"{'grains' if kind == 'sand' else kind} {kpa} kPa" for kind, kpa in tests) + " |")
    print("|---" * (len(tests) + 1) + "|")
    for name, *cells in zip(names, *columns):
        print("| " + " | ".join([name, *cells]) + " |")


if __name__ == "__main__":
    main()
