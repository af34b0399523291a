# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots deviator over axial strain of a cyclic test, strain added up over its stages from the third on.

usage: plot.py RUN PICTURE
"""
import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(Path(sys.argv[1]) / "history.csv", newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if int(row["stage"]) > 2]
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4))
    before = {"strain_z": 0.0, "volumetric_strain": 0.0}
    for stage in sorted({int(row["stage"]) for row in rows}):
        mine = [row for row in rows if int(row["stage"]) == stage]
        strain = [100 * (before["strain_z"] + float(row["strain_z"])) for row in mine]
        volume = [-100 * (before["volumetric_strain"] + float(row["volumetric_strain"])) for row in mine]
        color = "tab:red" if stage % 2 == 1 else "tab:blue"
        left.plot(strain, [1e-3 * float(row["deviator_Pa"]) for row in mine], color=color)
        right.plot(strain, volume, color=color)
        for name in before:
            before[name] += float(mine[-1][name])
    left.set_ylabel("deviator q [kPa]")
    right.set_ylabel("dilation [%]")
    for axes in (left, right):
        axes.set_xlabel("axial strain [%]")
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
