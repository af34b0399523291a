# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Scenes as text, dictionaries and simulations."""
from __future__ import annotations

import copy
import os
import tomllib
from typing import Any, Mapping

import tomli_w

from . import _reckon


class Scene:
    """The description of a run: a scene file, or a dictionary of the same tables and keys.

    Made whole: every fault of a scene is found when it is made, and all are in the one Error. `directory` is what
    relative paths in the scene are relative to.
    """

    def __init__(self, tables: Mapping[str, Any], directory: str | os.PathLike[str] = ".") -> None:
        self._start(tomli_w.dumps(_plain(tables)), directory, "the scene")

    @classmethod
    def from_text(cls, text: str, directory: str | os.PathLike[str] = ".") -> Scene:
        scene = cls.__new__(cls)
        scene._start(text, directory, "the scene")
        return scene

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Scene:
        scene = cls.__new__(cls)
        scene._directory = os.path.dirname(os.path.abspath(path))
        scene._compiled = _reckon._Scene(path)
        return scene

    def _start(self, text: str, directory: str | os.PathLike[str], name: str) -> None:
        self._directory = os.path.abspath(directory)
        self._compiled = _reckon._Scene.from_text(text, self._directory, name)

    @property
    def text(self) -> str:
        """As given, in TOML."""
        return self._compiled.text

    @property
    def tables(self) -> dict[str, Any]:
        """A copy of the given scene, as a dictionary."""
        return tomllib.loads(self.text)

    @property
    def title(self) -> str:
        return self._compiled.title

    @property
    def grain_count(self) -> int:
        """The number of placed grains."""
        return self._compiled.grain_count

    def resolved(self) -> str:
        """The scene with every default and the time step filled in, as a run folder's scene_resolved.toml."""
        return self._compiled.resolved()

    def changed(self, values: Mapping[str, Any]) -> Scene:
        """The same scene with other values, by their keys: {"material.friction": 0.3, "wall.2.friction": 0}.

        A number in a key is the place in an array of tables, from 0. Tables that are missing are made.
        """
        tables = copy.deepcopy(self.tables)
        for key, value in values.items():
            *parents, last = key.split(".")
            place: Any = tables
            for parent in parents:
                place = _child(place, parent, key)
            if isinstance(place, list):
                place[_index(place, last, key)] = value
            else:
                place[last] = value
        return Scene(tables, self._directory)


def handle_of(comm: Any) -> int | None:
    """The argument of the compiled half for a communicator of mpi4py, or for none."""
    return None if comm is None else comm.py2f()


def _plain(value: Any) -> Any:
    """Values for TOML: arrays and numbers of NumPy become lists and numbers of Python, paths become text."""
    if isinstance(value, Mapping):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(inner) for inner in value]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value.tolist() if hasattr(value, "tolist") else value


def _index(array: list[Any], word: str, key: str) -> int:
    if not word.isdigit() or int(word) >= len(array):
        raise _reckon.Error(f'key "{key}": "{word}" is no place in an array of {len(array)} tables. Count from 0.')
    return int(word)


def _child(place: Any, word: str, key: str) -> Any:
    if isinstance(place, list):
        return place[_index(place, word, key)]
    if not isinstance(place.setdefault(word, {}), (dict, list)):
        raise _reckon.Error(f'key "{key}": "{word}" is a value, not a table. Give the key of a value.')
    return place[word]


class Simulation:
    """A simulation of a scene, step by step; nothing is written.

    The same bits as `reckon run` of the scene. Its stages do not end by themselves: that is what `run` does.

    `comm` is a communicator of mpi4py, whose processes share the grains; all must make it, and call its methods, in
    the same order. Grains and contacts then come whole to its first process, and empty to the others.
    """

    def __init__(self, scene: Scene, comm: Any = None) -> None:
        self._comm = comm  # must exist as long
        self._compiled = _reckon._Simulation(scene._compiled, handle_of(comm))

    def step(self, count: int = 1) -> None:
        """Makes `count` steps. Other Python threads run meanwhile, and Ctrl-C works."""
        self._compiled.step(count)

    def begin_next_stage(self) -> None:
        self._compiled.begin_next_stage()

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._compiled.time

    @property
    def time_step(self) -> float:
        """[s]"""
        return self._compiled.time_step

    @property
    def planned_steps(self) -> int:
        """The number of steps of the scene; with stages, the maximum."""
        return self._compiled.planned_steps

    @property
    def step_number(self) -> int:
        return self._compiled.step_number

    @property
    def stage(self) -> str | None:
        """The name of the current stage; None without stages."""
        return self._compiled.stage

    def measure(self) -> dict[str, Any]:
        """The quantities of history.csv by name without the unit, those of the sample included, at the current step.

        Energies are in the dictionary `energy`, the forces on walls in the rows of `wall_force`, in scene order.
        """
        return self._compiled.measure()

    def grains(self) -> dict[str, Any]:
        """All grains, sorted by id: one array per quantity, with a row for each grain. A copy."""
        return self._compiled.grains()

    def contacts(self) -> dict[str, Any]:
        """All contacts, pairs sorted by ids, then walls. `force` is on `grain`. A copy."""
        return self._compiled.contacts()
