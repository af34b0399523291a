# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots triaxial tests of grains and of spheres, and the laboratory's of Dobrany sand.

usage: plot.py WORK PICTURE [DATA]
WORK holds runs sand-KPA and spheres-KPA. DATA has the laboratory's curves, ../shared/data/dobrany-sand
unless given; without them the plot shows the runs alone.
"""
import csv
import math
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves

COLORS = {50: "tab:blue", 100: "tab:orange", 200: "tab:green"}


def shear_stage(run: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Axial strain [%], mobilised friction angle [deg], dilation [%] of the last stage."""
    rows = curves.last_stage(run)

    def engineering(logarithmic: np.ndarray) -> np.ndarray:
        return 100 * (1 - np.exp(-logarithmic))

    return engineering(rows["strain_z"]), rows["friction_angle_deg"], -engineering(rows["volumetric_strain"])


def laboratory(data: Path, number: int) -> tuple[int, list[float], list[float], list[float]]:
    """Cell pressure [kPa] and the same three columns."""
    with open(data / f"derived_CID-REC-{number}.csv", newline="", encoding="utf-8") as file:
        rows = [[float(cell) for cell in row] for row in list(csv.reader(file))[2:]]
    angles = [math.degrees(math.asin(q / (q + 2 * radial))) for _, radial, q, _ in rows]
    return round(rows[0][1]), [row[0] for row in rows], angles, [-row[3] for row in rows]


def main() -> None:
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    work = Path(sys.argv[1])
    root = Path(__file__).resolve().parents[2]
    data = Path(sys.argv[3]) if len(sys.argv) == 4 else root / "../shared/data/dobrany-sand"
    measured = (data / "derived_CID-REC-1.csv").exists()
    figure, axes = curves.plt.subplots(2, 2 if measured else 1, sharex=True, sharey="row", squeeze=False, figsize=(9, 6.5))
    for kind, style in (("sand", "-"), ("spheres", "--")):
        for kpa, color in COLORS.items():
            run = work / f"{kind}-{kpa}"
            if not (run / "history.csv").exists():
                continue
            strain, angle, dilation = shear_stage(run)
            label = f"{'grains' if kind == 'sand' else 'spheres'}, {kpa} kPa"
            axes[0][0].plot(strain, angle, style, color=color, lw=1, label=label)
            axes[1][0].plot(strain, dilation, style, color=color, lw=1)
    axes[0][0].set_title("simulated", fontsize=10)
    if measured:
        for number in (1, 2, 3):
            kpa, strain, angle, dilation = laboratory(data, number)
            axes[0][1].plot(strain, angle, color=COLORS[kpa], label=f"Dobrany sand, {kpa} kPa")
            axes[1][1].plot(strain, dilation, color=COLORS[kpa])
        axes[0][1].set_title("laboratory", fontsize=10)
    axes[0][0].set_ylabel("mobilised friction angle [deg]")
    axes[1][0].set_ylabel("dilation [%]")
    axes[0][0].set_ylim(0, 60)
    for each in axes.flat:
        each.set_xlim(0, 16)
    for each in axes[0]:
        each.legend(frameon=False, fontsize=7, loc="lower right", ncol=2)
    for each in axes[1]:
        each.set_xlabel("axial strain [%]")
    curves.save(figure, sys.argv[2])


if __name__ == "__main__":
    main()
