# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints what tests with several seeds found, mean and standard deviation, and plots their curves.

usage: seeds.py WORK PICTURE
WORK holds runs sand-SEED and spheres-SEED, and beside each what `reckon run --json` said of it, as RUN.json.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves
from plot import shear_curves

KINDS = {"sand": ("grains", "tab:blue"), "spheres": ("spheres of the same volumes", "tab:orange")}


def figures(run: Path) -> dict[str, float]:
    answer = curves.answer(run)
    shear = answer["driven_stages"][-1]
    rows = curves.last_stage(run)
    return {
        "void ratio before shearing": rows["void_ratio"][0],
        "peak friction angle [°]": shear["peak_friction_angle_deg"],
        "axial strain there [%]": 100 * shear["strain_at_peak"],
        "dilatancy angle there [°]": shear["dilatancy_angle_deg"],
        "friction angle over the last fifth [°]": curves.late_friction_angle(rows),
        "void ratio at 15 % strain": rows["void_ratio"][-1],
        "difference of stress by contacts and by walls, median row [%]": 100 * shear["stress_disagreement"],
        "energy balance error, of the energy turned over [%]": curves.energy_error_percent(answer),
    }


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    figure, plots = curves.plt.subplots(2, 1, sharex=True, figsize=(6, 6))
    columns = []
    for kind, (label, colour) in KINDS.items():
        runs = sorted(path.with_suffix("") for path in Path(sys.argv[1]).glob(f"{kind}-*.json"))
        found = [figures(run) for run in runs]
        columns.append({name: np.array([figure[name] for figure in found]) for name in found[0]})
        for number, run in enumerate(runs):
            strain, *shown = shear_curves(run)
            for axes, y in zip(plots, shown):
                axes.plot(strain, y, color=colour, linewidth=0.7, label=None if number else f"{label}, {len(runs)} seeds")
    print("| | " + " | ".join(label for label, _ in KINDS.values()) + " |")
    print("|---" * (len(KINDS) + 1) + "|")
    for name in columns[0]:
        digits = 3 if "void" in name else 2 if "[%]" in name and "strain" not in name else 1
        cells = [f"{column[name].mean():.{digits}f} ± {column[name].std(ddof=1):.{digits}f}" for column in columns]
        print(f"| {name} | " + " | ".join(cells) + " |")
    plots[0].set_ylim(bottom=0)
    plots[0].legend(frameon=False)
    plots[0].set_ylabel("stress ratio q/p")
    plots[1].set_ylabel("dilation [%]")
    plots[1].set_xlabel("axial strain [%]")
    curves.save(figure, sys.argv[2])


if __name__ == "__main__":
    main()
