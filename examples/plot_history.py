# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots one column of a run's history.csv over another.

usage: plot_history.py RUN PICTURE X Y [--stages 2,3] [--log-x] [--labels "x" "y"]
"""
import argparse
import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run")
    parser.add_argument("picture")
    parser.add_argument("x")
    parser.add_argument("y")
    parser.add_argument("--stages", help="numbers of the stages to show, one line each")
    parser.add_argument("--log-x", action="store_true")
    parser.add_argument("--labels", nargs=2)
    arguments = parser.parse_args()
    with open(Path(arguments.run) / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    stages = arguments.stages.split(",") if arguments.stages else sorted({row["stage"] for row in rows})
    figure, axes = plt.subplots(figsize=(6, 4))
    for stage in stages:
        points = [(float(row[arguments.x]), float(row[arguments.y])) for row in rows if row["stage"] == stage]
        axes.plot(*zip(*points), label=f"stage {stage}")
    if arguments.log_x:
        axes.set_xscale("log")
    axes.set_xlabel(arguments.labels[0] if arguments.labels else arguments.x)
    axes.set_ylabel(arguments.labels[1] if arguments.labels else arguments.y)
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(arguments.picture, dpi=150)


if __name__ == "__main__":
    main()
