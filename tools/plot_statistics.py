#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the tables of `reckon grains statistics -o`: cumulative curves, one SVG beside each CSV file.

  tools/plot_statistics.py sand.csv more.csv      several files share one picture with --together
"""
import argparse
import csv
import pathlib

from svg_plots import plt


def read_columns(path):
    """Columns of numbers by name; the first column holds names of grains."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        raise SystemExit(f"{path}: has no grains")
    return {name: sorted(float(row[name]) for row in rows) for name in list(rows[0])[1:]}


def plot(tables, target):
    """A panel per quantity, a curve per table."""
    names = list(next(iter(tables.values())))
    figure, axes = plt.subplots(2, (len(names) + 1) // 2, figsize=(13, 5.2), sharey=True,
                                squeeze=False)
    for panel, name in zip(axes.flat, names):
        for label, columns in tables.items():
            values = columns[name]
            shares = [100 * (n + 0.5) / len(values) for n in range(len(values))]
            panel.plot(values, shares, linewidth=1, label=label)
        panel.set_xlabel(name.replace("_m", " [m]").replace("_", " "))
        panel.grid(alpha=0.3)
    for panel in axes.flat[len(names):]:
        panel.set_visible(False)
    for panel in axes[:, 0]:
        panel.set_ylabel("grains below [%]")
    axes.flat[0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(target, metadata={"Date": None})
    return target


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tables", nargs="+", type=pathlib.Path)
    parser.add_argument("--together", type=pathlib.Path, help="one picture for all tables")
    arguments = parser.parse_args()
    tables = {path: {path.stem: read_columns(path)} for path in arguments.tables}
    if arguments.together:
        merged = {label: columns for one in tables.values() for label, columns in one.items()}
        print(plot(merged, arguments.together))
        return
    for path, table in tables.items():
        print(plot(table, path.with_suffix(".svg")))


if __name__ == "__main__":
    main()
