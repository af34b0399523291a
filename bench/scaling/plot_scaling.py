#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the tables that bench/scaling/run.sh makes.

  bench/scaling/plot_scaling.py docs/performance/scaling docs/images [--format svg]

Tables that are missing are left out. Of repeated measurements the fastest counts: other programs
can only slow a run down.
"""
import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "reckon"  # equal tables give equal files
matplotlib.rcParams["svg.fonttype"] = "none"
import matplotlib.pyplot as plt  # noqa: E402: the backend comes first

BAR = 1.10  # the promise for `balanced`: largest work / mean work
COLOURS = {"grid": "tab:orange", "balanced": "tab:blue", "paper": "0.45"}
# Table 1 of the paper: seconds for 4736 grains.
PAPER_4736 = {1: 852.359, 2: 459.581, 4: 234.757, 8: 118.234, 16: 59.269, 32: 35.175, 64: 20.198}


def number(text):
    """The number in a field, or its text."""
    try:
        return float(text)
    except ValueError:
        return text


def read_table(path):
    """Rows of a CSV file as dictionaries."""
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def curve(rows, column, **conditions):
    """Ranks and a column's values of the rows that meet the conditions."""
    chosen = [row for row in rows if all(row[key] == value for key, value in conditions.items())]
    return [row["ranks"] for row in chosen], [row[column] for row in chosen]


def logarithmic_ranks(axes, ranks):
    axes.set_xscale("log", base=2)
    axes.set_xticks(ranks, [f"{rank:g}" for rank in ranks])
    axes.minorticks_off()
    axes.set_xlabel("ranks")


def plot_strong(tables):
    """Speed-up that the counted work allows, beside what the paper measured and its bins allow."""
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 4.2), sharey=True)
    bins = [row for row in read_table(tables / "bins.csv") if row["table"] == 2.0]
    ranks = [row["ranks"] for row in bins]
    seconds = [row["paper_seconds"] for row in bins]
    panels[0].plot(ranks, [seconds[0] / s for s in seconds], "s-", color=COLOURS["paper"],
                   label="paper, measured", markersize=4)
    panels[0].plot(ranks, [bins[0]["actual"] / row["actual"] for row in bins], "--",
                   color=COLOURS["paper"], label="paper's actual bins")
    panels[0].set_title("42,684 grains", fontsize="medium")
    panels[1].plot(list(PAPER_4736), [PAPER_4736[1] / s for s in PAPER_4736.values()], "s-",
                   color=COLOURS["paper"], label="paper, measured", markersize=4)
    panels[1].set_title("4736 grains", fontsize="medium")
    for axes, grains in zip(panels, (42684, 4736)):
        rows = read_table(tables / f"paper-{grains}.csv")
        for kind in ("grid", "balanced"):
            axes.plot(*curve(rows, "speed_up", decomposition=kind), "o-", color=COLOURS[kind],
                      label=f"{kind}, counted work", markersize=3.5)
        most = max(row["ranks"] for row in rows)
        axes.plot([1, most], [1, most], ":", color="0.2", label="ideal")
        logarithmic_ranks(axes, [2 ** n for n in range(9) if 2 ** n <= most])
        axes.set_yscale("log", base=2)
        axes.set_yticks([2 ** n for n in range(9)], [str(2 ** n) for n in range(9)])
        axes.legend(fontsize="small")
        axes.grid(color="0.92")
    panels[0].set_ylabel("speed-up")
    return figure


def plot_weak(tables):
    """Time per rank as the domain grows with the ranks, over that of one rank."""
    rows = read_table(tables / "weak.csv")
    paper = read_table(tables / "bins.csv")
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 4.0), sharey=True)
    for axes, series, grains in zip(panels, (1, 2), (481, 1328)):
        mine = [row for row in paper if row["table"] == round(3 + series / 10, 1)]
        ranks = [row["ranks"] for row in mine]
        axes.plot(ranks, [row["paper_seconds"] / mine[0]["paper_seconds"] for row in mine], "s-",
                  color=COLOURS["paper"], label="paper, measured time", markersize=4)
        for kind in ("grid", "balanced"):
            counted = [row for row in rows if row["assembly"] == f"series {series}"
                       and row["decomposition"] == kind]
            axes.plot([row["ranks"] for row in counted],
                      [row["most_work"] / counted[0]["most_work"] for row in counted], "o-", color=COLOURS[kind],
                      label=f"{kind}, counted work", markersize=3.5)
        axes.set_title(f"{grains} grains a rank", fontsize="medium")
        logarithmic_ranks(axes, [1, 8, 27, 64, 125, 216, 512])
        axes.legend(fontsize="small", loc="lower right")
        axes.grid(color="0.92")
    panels[0].set_ylabel("busiest rank / one rank alone")
    panels[0].set_ylim(0, None)
    return figure


def plot_evenness(tables):
    """Largest work / mean work for arrangements that equal blocks do not suit."""
    figure, axes = plt.subplots(figsize=(6.4, 4.2))
    for name, style in (("heap-42684", "o-"), ("heap-4096", "o--"), ("cube-42684", "s-"),
                        ("cube-4096", "s--"), ("squeezed-4096", "^:")):
        path = tables / f"{name}.csv"
        if not path.exists():
            continue
        rows = read_table(path)
        assembly, grains = name.split("-")
        for kind in ("grid", "balanced"):
            axes.plot(*curve(rows, "work_ratio", decomposition=kind), style, color=COLOURS[kind],
                      label=f"{kind}: {assembly}, {int(grains):,} grains", markersize=3.5)
    axes.axhline(BAR, color="tab:red", linewidth=0.9)
    axes.annotate(f"{BAR:.2f}", (1, BAR), xytext=(2, 4), textcoords="offset points",
                  color="tab:red", fontsize="small")
    logarithmic_ranks(axes, [2 ** n for n in range(10)])
    axes.set_yscale("log")
    axes.set_yticks([1, 1.5, 2, 3, 4, 5], ["1", "1.5", "2", "3", "4", "5"])
    axes.minorticks_off()
    axes.set_ylabel("largest work / mean work")
    axes.legend(fontsize="x-small", loc="upper left")
    axes.grid(color="0.92")
    return figure


def fastest(rows):
    """For each case the repeat with the shortest step, by (grains, ranks, threads, decomposition)."""
    best = {}
    for row in rows:
        key = (int(row["grains"]), int(row["ranks"]), int(row["threads"]), row["decomposition"])
        if key not in best or row["step_us"] < best[key]["step_us"]:
            best[key] = row
    return best


PHASES = (("grain_contacts_us", "grain contacts"), ("walls_us", "walls"),
          ("frames_motion_us", "frames, motion"), ("lists_us", "pair lists"),
          ("border_us", "border"), ("migration_us", "migration"), ("agreement_us", "agreement"))


def plot_phases(tables):
    """Where the time of a measured step goes, per grain (the paper's Fig. 14)."""
    best = fastest(read_table(tables / "measured.csv"))
    cases = [(1, 1), (1, 2), (2, 1), (2, 2), (4, 1)]
    sizes = [grains for grains in (592, 1998, 4736) if (grains, 1, 1, "balanced") in best]
    figure, panels = plt.subplots(1, len(sizes), figsize=(3.2 * len(sizes), 3.8), sharey=True,
                                  squeeze=False)
    for axes, grains in zip(panels[0], sizes):
        shown = [case for case in cases if (grains, *case, "balanced") in best]
        below = [0.0] * len(shown)
        for column, label in PHASES:
            heights = [1e3 * best[grains, *case, "balanced"][column] * case[0] / grains
                       for case in shown]
            axes.bar(range(len(shown)), heights, 0.7, bottom=below, label=label)
            below = [low + height for low, height in zip(below, heights)]
        axes.set_xticks(range(len(shown)), [f"{ranks}×{threads}" for ranks, threads in shown])
        axes.set_xlabel("ranks × threads")
        axes.set_title(f"{grains} grains", fontsize="medium")
    panels[0][0].set_ylabel("ranks × time of a step / grains [ns]")
    panels[0][-1].legend(fontsize="x-small")
    return figure


PLOTS = {"scaling-strong": (plot_strong, "bins.csv"), "scaling-weak": (plot_weak, "weak.csv"),
         "scaling-evenness": (plot_evenness, "heap-4096.csv"),
         "scaling-phases": (plot_phases, "measured.csv")}


def main():
    parser = argparse.ArgumentParser(description="Plots the tables of the scaling benchmark.")
    parser.add_argument("tables", type=pathlib.Path, help="folder of the CSV files")
    parser.add_argument("images", type=pathlib.Path, help="folder of the plots")
    parser.add_argument("--format", default="svg")
    arguments = parser.parse_args()
    for name, (draw, needed) in PLOTS.items():
        if not (arguments.tables / needed).exists():
            continue
        figure = draw(arguments.tables)
        figure.tight_layout()
        path = arguments.images / f"{name}.{arguments.format}"
        metadata = {"Date": None} if arguments.format == "svg" else None
        figure.savefig(path, metadata=metadata)
        plt.close(figure)
        print(path)


if __name__ == "__main__":
    main()
