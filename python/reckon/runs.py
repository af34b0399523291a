# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Complete runs and their folders."""
from __future__ import annotations

import json
import os
import pathlib
import warnings
from typing import Any, Callable

import numpy

from . import _reckon
from .scenes import Scene, handle_of


class InvalidRunWarning(UserWarning):
    """The figures of a run mean nothing. The message gives the reasons."""


class Run:
    """The folder of a run, by this package or by `reckon run`; the run may be in progress.

    Where its figures mean nothing, an InvalidRunWarning says so and why when it is opened.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = pathlib.Path(folder)
        if not _reckon._holds_run(self.folder):
            raise _reckon.Error(f"{self.folder}: there is no run in this folder. Give the folder of a run.")
        if not self.valid:
            why = "; ".join(text for _, text in self.reasons)
            warnings.warn(f"the figures of {self.folder} mean nothing: {why}", InvalidRunWarning, stacklevel=2)

    @property
    def valid(self) -> bool:
        """Whether the figures of the run mean something."""
        return _reckon._verdict(self.folder)["valid"]

    @property
    def reasons(self) -> list[tuple[str, str]]:
        """The reasons if they do not: a code and a text each, e.g. ("negative_void_ratio", ...)."""
        return _reckon._verdict(self.folder)["reasons"]

    @property
    def history(self) -> dict[str, numpy.ndarray]:
        """The columns of history.csv by name (docs/reference/history.md); cells without a number are NaN."""
        header, rows = _reckon._history(self.folder)
        table = numpy.array([[float(cell) if cell else numpy.nan for cell in row] for row in rows])
        table = table.reshape(len(rows), len(header))
        return {name: table[:, n].copy() for n, name in enumerate(header)}

    @property
    def steps(self) -> list[int]:
        """The steps at which grains were saved."""
        return _reckon._steps(self.folder)

    def fields(self, step: int = -1) -> dict[str, Any]:
        """Grains, contacts (None if the run kept none) and time at a saved step; by default the last."""
        if step < 0:
            steps = self.steps
            if not steps:
                raise _reckon.Error(f"{self.folder}: no grains have been saved yet. See `output.fields_interval`.")
            step = steps[step]
        return _reckon._fields(self.folder, step)

    @property
    def scene(self) -> str:
        """The scene as used, in TOML, with every default."""
        return (self.folder / "scene_resolved.toml").read_text()

    @property
    def record(self) -> dict[str, Any]:
        """The program, machine and times of the run (run.json)."""
        return json.loads((self.folder / "run.json").read_text())

    def __repr__(self) -> str:
        return f"<reckon.Run {str(self.folder)!r}>"


def run(
    scene: Scene,
    folder: str | os.PathLike[str],
    *,
    steps: int | None = None,
    resume: bool = False,
    overwrite: bool = False,
    progress: Callable[[int, int], None] | None = None,
    comm: Any = None,
) -> Run:
    """Runs a scene to its end, as `reckon run` does, and returns its folder, whose `report` states how it ended.

    `progress(step, steps)` is called ten times a second at most. Ctrl-C, or an exception of `progress`, ends the run
    with a checkpoint from which `resume` goes on to the same bits. `comm` is a communicator of mpi4py whose processes
    share the grains: all of them must call this; the files are the same for any number of them.
    """
    report = _reckon._run(scene._compiled, folder, resume, overwrite, steps, progress, handle_of(comm))
    finished = Run(folder)
    finished.report = report
    return finished
