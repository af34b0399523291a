#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots verification tables: one SVG beside each CSV file.

The first column is the abscissa, every other column a curve. By default both axes are logarithmic
and dashed guides of the given slopes start at the curves' geometric mean: for tables of errors over
resolution. --linear is for histories.

  tools/plot_verification.py docs/verification/shape/*.csv
"""
import argparse
import csv
import math
import pathlib
import sys

from svg_plots import plt


def read_table(path):
    """Column names and columns of numbers."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names, body = rows[0], rows[1:]
    if not body or any(len(row) != len(names) for row in body):
        raise SystemExit(f"{path}: needs a header and rows of {len(names)} numbers")
    return names, [list(column) for column in zip(*[map(float, row) for row in body])]


def add_guides(axes, abscissa, curves, slopes):
    """Dashed lines of error ~ abscissa^-slope."""
    positive = [y for curve in curves for y in curve if y > 1e-9]
    if not positive:
        return
    middle_y = math.exp(sum(map(math.log, positive)) / len(positive))
    middle_x = math.sqrt(abscissa[0] * abscissa[-1])
    for slope in slopes:
        axes.loglog(abscissa, [middle_y * (x / middle_x) ** -slope for x in abscissa], "--",
                    color="0.7", linewidth=0.8, label=f"slope -{slope:g}")


def plot(path, slopes, linear):
    """Draws the table at `path` and returns the name of the picture."""
    names, columns = read_table(path)
    abscissa, curves = columns[0], columns[1:]
    figure, axes = plt.subplots(figsize=(6.4, 4.4))
    for name, curve in zip(names[1:], curves):
        label = name.replace("_", " ")
        if linear:
            axes.plot(abscissa, curve, label=label)
        elif max(curve) > 1e-9:  # what is exact has no place on a logarithmic axis
            axes.loglog(abscissa, curve, "o-", markersize=3, label=label)
    if not linear:
        add_guides(axes, abscissa, curves, slopes)
        axes.set_xticks(abscissa, [f"{x:g}" for x in abscissa])
        axes.minorticks_off()
        axes.set_ylabel("relative error")
    axes.set_xlabel(names[0].replace("_", " "))
    axes.set_title(path.stem.replace("_", " "))
    axes.grid(True, color="0.9")
    axes.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    picture = path.with_suffix(".svg")
    figure.savefig(picture, bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
    return picture


def main():
    """Plots every table that is named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="+", type=pathlib.Path)
    parser.add_argument("--slopes", type=float, nargs="*", default=[1, 2])
    parser.add_argument("--linear", action="store_true")
    options = parser.parse_args()
    for path in options.tables:
        print(plot(path, options.slopes, options.linear))
    return 0


if __name__ == "__main__":
    sys.exit(main())
