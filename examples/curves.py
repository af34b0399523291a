# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Common parts of the plots of the examples: reading history.csv and files of fields, plots below each other."""
import csv
import json
import re
import sys
from collections.abc import Callable
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


def answer(run: Path) -> dict:
    """The output of `reckon run --json`: RUN.json beside the run."""
    return json.loads(run.with_suffix(".json").read_text(encoding="utf-8"))


def energy_error_percent(answered: dict) -> float:
    """The energy balance error, of the energy turned over."""
    return 100 * abs(answered["energy_error_J"]) / answered["energy_turnover_J"]


def late_friction_angle(rows: Columns) -> float:
    """The mean over the last fifth of the axial strain [degrees]."""
    strain = 1 - np.exp(-rows["strain_z"])
    return rows["friction_angle_deg"][strain > 0.8 * strain[-1]].mean()


def arrays(path: Path) -> dict[str, np.ndarray]:
    """The named arrays of a .vtp file with raw appended data."""
    data = path.read_bytes()
    start = data.index(b"_", data.index(b"<AppendedData")) + 1
    head = data[:start].decode("utf-8", "replace")
    kinds = {"Float64": "<f8", "Float32": "<f4", "UInt32": "<u4", "UInt8": "u1", "Int64": "<i8"}
    found = {}
    for tag in re.findall(r"<DataArray[^>]*>", head):
        fields = dict(re.findall(r'(\w+)="([^"]*)"', tag))
        if fields.get("format") != "appended" or fields["type"] not in kinds:
            continue
        at = start + int(fields["offset"])
        size = int.from_bytes(data[at : at + 8], "little")
        values = np.frombuffer(data[at + 8 : at + 8 + size], kinds[fields["type"]])
        width = int(fields.get("NumberOfComponents", 1))
        found[fields.get("Name", "")] = values.reshape(-1, width) if width > 1 else values
    return found


def runs_and_labels(arguments: list[str]) -> list[tuple[str, str]]:
    """RUN=LABEL or RUN each."""
    return [(run, label or run) for run, _, label in (argument.partition("=") for argument in arguments)]


def plot_runs(usage: str, x: str, names: list[str], curve_of: Callable[[str, str], tuple]) -> None:
    """The program of a script with the arguments PICTURE RUN[=LABEL]...: `curve_of(run, label)` is (x, y of the first, ...)."""
    if len(sys.argv) < 3:
        sys.exit(usage)
    lines = [(label, *curve_of(run, label)) for run, label in runs_and_labels(sys.argv[2:])]
    plot_over_one_axis(sys.argv[1], x, names, lines)


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
