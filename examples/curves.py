# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the plots of the examples share: reading history.csv, and plots below each other."""
import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

Columns = dict[str, np.ndarray]


def history(run: str | Path) -> Columns:
    """The columns of a run's history.csv."""
    with open(Path(run) / "history.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}


def stage(columns: Columns, number: int) -> Columns:
    """The rows of one stage."""
    return {name: values[columns["stage"] == number] for name, values in columns.items()}


def last_stage(run: str | Path) -> Columns:
    """The rows of a run's last stage."""
    columns = history(run)
    return stage(columns, columns["stage"][-1])


def runs_and_labels(arguments: list[str]) -> list[tuple[str, str]]:
    """RUN=LABEL or RUN each."""
    return [(run, label or run) for run, _, label in (argument.partition("=") for argument in arguments)]


def plot_over_one_axis(picture: str, x: str, names: list[str], curves: list[tuple]) -> None:
    """Plots below each other, named by what they show; a curve is (label, x, y of the first, y of the second, ...)."""
    figure, plots = plt.subplots(len(names), 1, sharex=True, figsize=(6, 3 * len(names)))
    for label, along, *values in curves:
        for axes, y in zip(plots, values):
            axes.plot(along, y, label=label)
    for axes, name in zip(plots, names):
        axes.set_ylabel(name)
    plots[0].set_ylim(bottom=0)
    if len(curves) > 1:
        plots[0].legend(frameon=False)
    plots[-1].set_xlabel(x)
    save(figure, picture)


def save(figure: plt.Figure, picture: str) -> None:
    """Writes a picture with a light grid in all its plots."""
    for axes in figure.axes:
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(picture, dpi=150)
