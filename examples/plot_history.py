# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots one column of a run's history.csv over another.

usage: plot_history.py RUN PICTURE X Y [--stages 2,3] [--log-x] [--labels "x" "y"]
"""
import argparse

import curves


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
    columns = curves.history(arguments.run)
    shown = arguments.stages.split(",") if arguments.stages else sorted(set(columns["stage"]))
    figure, axes = curves.plt.subplots(figsize=(6, 4))
    for number in map(int, shown):
        rows = curves.stage(columns, number)
        axes.plot(rows[arguments.x], rows[arguments.y], label=f"stage {number}")
    if arguments.log_x:
        axes.set_xscale("log")
    axes.set_xlabel(arguments.labels[0] if arguments.labels else arguments.x)
    axes.set_ylabel(arguments.labels[1] if arguments.labels else arguments.y)
    axes.legend(frameon=False)
    curves.save(figure, arguments.picture)


if __name__ == "__main__":
    main()
