# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the shear stage of a run in a periodic cell.

usage: plot.py PICTURE RUN
Shear stress over normal stress, and dilation, over shear strain.
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
    with open(Path(sys.argv[2]) / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    rows = [row for row in rows if row["stage"] == rows[-1]["stage"]]
    shear = [100 * float(row["cell_shear_xy"]) for row in rows]
    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(6, 6))
    top.plot(shear, [-float(row["stress_xy_Pa"]) / float(row["stress_yy_Pa"]) for row in rows])
    top.set_ylabel("shear stress / normal stress")
    bottom.plot(shear, [-100 * float(row["volumetric_strain"]) for row in rows])
    bottom.set_ylabel("dilation [%]")
    bottom.set_xlabel("shear strain [%]")
    for axes in (top, bottom):
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(sys.argv[1], dpi=150)


if __name__ == "__main__":
    main()
