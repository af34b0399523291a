# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots how many grains have left a hopper over time, and prints the steady rate.

usage: plot.py RUN PICTURE
The rate is the slope between a tenth and half of all grains gone.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    columns = curves.history(sys.argv[1])
    time, gone = columns["time_s"], columns["departed"]
    all_grains = gone[0] + columns["grains"][0]
    steady = (gone > 0.1 * all_grains) & (gone < 0.5 * all_grains)
    rate, at_zero = np.polyfit(time[steady], gone[steady], 1)
    print(f"{rate:.0f} grains per second; {gone[-1]:.0f} of {all_grains:.0f} are gone at the end")
    figure, axes = curves.plt.subplots(figsize=(6, 4))
    axes.plot(time, gone)
    axes.plot(time[steady], rate * time[steady] + at_zero, "k--", label=f"{rate:.0f} per second")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("grains gone")
    axes.legend(frameon=False)
    curves.save(figure, sys.argv[2])


if __name__ == "__main__":
    main()
