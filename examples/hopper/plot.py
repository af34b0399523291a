# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots how many grains have left a hopper over time, and prints the steady rate.

usage: plot.py RUN PICTURE
The rate is the slope between a tenth and half of all grains gone.
"""
import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(Path(sys.argv[1]) / "history.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    time = np.array([float(row["time_s"]) for row in rows])
    gone = np.array([float(row["departed"]) for row in rows])
    all_grains = gone[0] + float(rows[0]["grains"])
    steady = (gone > 0.1 * all_grains) & (gone < 0.5 * all_grains)
    rate, at_zero = np.polyfit(time[steady], gone[steady], 1)
    print(f"{rate:.0f} grains per second; {gone[-1]:.0f} of {all_grains:.0f} are gone at the end")
    figure, axes = plt.subplots(figsize=(6, 4))
    axes.plot(time, gone)
    axes.plot(time[steady], rate * time[steady] + at_zero, "k--", label=f"{rate:.0f} per second")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("grains gone")
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
