# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Shows the slope that a run of angle-of-repose ended in, and prints its angle.

usage: plot.py RUN PICTURE
The surface is that of the highest grain in each of 16 strips; the line of least squares goes through
those between a tenth and nine tenths of its height, where neither wall is near.
"""
import sys
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    last = sorted((Path(sys.argv[1]) / "checkpoints").glob("step_*.h5"))[-1]
    with h5py.File(last, "r") as file:
        place = 1e3 * file["/grain/position"][:]
    radius = 0.5  # half of d50 [mm], for the picture alone
    strips = np.linspace(place[:, 0].min(), place[:, 0].max(), 17)
    strip = np.clip(np.searchsorted(strips, place[:, 0]) - 1, 0, 15)
    top = [place[strip == n][np.argmax(place[strip == n, 2])] for n in range(16) if (strip == n).any()]
    top = np.array(top)
    low, high = np.quantile(top[:, 2], [0, 1])
    part = (top[:, 2] > low + 0.1 * (high - low)) & (top[:, 2] < low + 0.9 * (high - low))
    slope, at_zero = np.polyfit(top[part, 0], top[part, 2], 1)
    angle = -np.degrees(np.arctan(slope))
    print(f"angle of repose {angle:.1f} deg")
    figure, axes = plt.subplots(figsize=(8, 3.5))
    circles = [plt.Circle((x, z), radius) for x, z in place[np.argsort(place[:, 1])][:, [0, 2]]]
    axes.add_collection(PatchCollection(circles, facecolor="#d8b365", edgecolor="#8c6d31", linewidth=0.4))
    axes.plot(top[part, 0], slope * top[part, 0] + at_zero, "k--", label=f"{angle:.1f}°")
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_xlabel("[mm]")
    axes.set_ylabel("[mm]")
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
