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


def curve(run: str, _label: str) -> tuple:
    shear = curves.last_stage(run)
    ratio = -shear["stress_xy_Pa"] / shear["stress_yy_Pa"]
    return 100 * shear["cell_shear_xy"], ratio, -100 * shear["volumetric_strain"]


if __name__ == "__main__":
    curves.plot_runs(__doc__, "shear strain [%]", ["shear stress / normal stress", "dilation [%]"], curve)
