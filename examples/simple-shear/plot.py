# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the shear stage of one or more runs in a periodic cell.

usage: plot.py PICTURE RUN[=LABEL]...
Shear stress over normal stress, and dilation, over shear strain.
"""
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    lines = []
    for run, label in curves.runs_and_labels(sys.argv[2:]):
        shear = curves.last_stage(run)
        ratio = -shear["stress_xy_Pa"] / shear["stress_yy_Pa"]
        lines.append((label, 100 * shear["cell_shear_xy"], ratio, -100 * shear["volumetric_strain"]))
    names = ["shear stress / normal stress", "dilation [%]"]
    curves.plot_over_one_axis(sys.argv[1], "shear strain [%]", names, lines)


if __name__ == "__main__":
    main()
