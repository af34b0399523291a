# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the shear stage of one or more direct shear tests.

usage: plot.py PICTURE RUN[=LABEL]...
Shear over normal force on the upper half, and the rise of its lid, over the displacement.
Prints the peak, the last fifth and the steepest rise.
"""
import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

SPEED = 50e-3  # of the upper half [m/s]


def shear_stage(run: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Displacement [m], force ratio and rise of the lid [m] of a run's last stage."""
    with open(Path(run) / "history.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    rows = [row for row in rows if row["stage"] == rows[-1]["stage"]]

    def column(name: str) -> np.ndarray:
        return np.array([float(row[name]) for row in rows])

    shear = -sum(column(f"{wall}:fx_N") for wall in ("upper-left", "upper-right", "top"))
    height = column("size_z_m")
    time = column("time_s")
    return SPEED * (time - time[0]), shear / column("top:fz_N"), height - height[0]


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(6, 6))
    for argument in sys.argv[2:]:
        run, _, label = argument.partition("=")
        moved, ratio, rise = shear_stage(run)
        smooth = np.convolve(ratio, np.ones(9) / 9, mode="same")  # over some 0.02 mm
        peak = int(np.argmax(smooth[5:-5])) + 5
        late = ratio[moved > 0.8 * moved[-1]].mean()
        around = np.abs(moved - moved[peak]) < 0.1e-3
        slope = np.polyfit(moved[around], rise[around], 1)[0]
        print(
            f"{label or run}: peak {smooth[peak]:.3f} ({np.degrees(np.arctan(smooth[peak])):.1f} deg) at "
            f"{1e3 * moved[peak]:.2f} mm, there rising {np.degrees(np.arctan(slope)):.1f} deg; "
            f"last fifth {late:.3f} ({np.degrees(np.arctan(late)):.1f} deg); rise {1e3 * rise[-1]:.2f} mm"
        )
        top.plot(1e3 * moved, ratio, label=label or run)
        bottom.plot(1e3 * moved, 1e3 * rise)
    top.set_ylabel("shear over normal force")
    top.set_ylim(bottom=0)
    top.legend(frameon=False)
    bottom.set_ylabel("rise of the lid [mm]")
    bottom.set_xlabel("displacement of the upper half [mm]")
    for axes in (top, bottom):
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(sys.argv[1], dpi=150)


if __name__ == "__main__":
    main()
