# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the shear stage of one or more direct shear tests.

usage: plot.py PICTURE RUN[=LABEL]...
Shear over normal force on the upper half, and the rise of its lid, over the displacement.
Prints the peak, the last fifth and the steepest rise.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves

SPEED = 50e-3  # of the upper half [m/s]


def degrees(slope: float) -> float:
    return float(np.degrees(np.arctan(slope)))


def curve(run: str, label: str) -> tuple:
    shear = curves.last_stage(run)
    moved = SPEED * (shear["time_s"] - shear["time_s"][0])
    rise = shear["size_z_m"] - shear["size_z_m"][0]
    ratio = -sum(shear[f"{wall}:fx_N"] for wall in ("upper-left", "upper-right", "top")) / shear["top:fz_N"]
    smooth = np.convolve(ratio, np.ones(9) / 9, mode="same")  # over some 0.02 mm
    peak = int(np.argmax(smooth[5:-5])) + 5
    late = ratio[moved > 0.8 * moved[-1]].mean()
    around = np.abs(moved - moved[peak]) < 0.1e-3
    slope = np.polyfit(moved[around], rise[around], 1)[0]
    print(
        f"{label}: peak {smooth[peak]:.3f} ({degrees(smooth[peak]):.1f} deg) at "
        f"{1e3 * moved[peak]:.2f} mm, there rising {degrees(slope):.1f} deg; "
        f"last fifth {late:.3f} ({degrees(late):.1f} deg); rise {1e3 * rise[-1]:.2f} mm"
    )
    return 1e3 * moved, ratio, 1e3 * rise


if __name__ == "__main__":
    names = ["shear over normal force", "rise of the lid [mm]"]
    curves.plot_runs(__doc__, "displacement of the upper half [mm]", names, curve)
