# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
import os
from typing import Any, Callable, Sequence

import numpy
from numpy.typing import ArrayLike, NDArray

_Path = str | os.PathLike[str]
__version__: str

class Error(RuntimeError):
    """An error: place, problem, reason and remedy."""

def set_threads(count: int) -> None:
    """The number of threads from now on. No result depends on it."""

def threads() -> int: ...

class Shape:
    """One grain's geometry in its body frame: origin at the centre of mass, axes along those of inertia."""

    @property
    def name(self) -> str: ...
    @property
    def level_set(self) -> NDArray[numpy.float32]:
        """Signed distances at the grid's vertices, [z, y, x], negative inside [m]. Not a copy; read-only."""
    @property
    def spacing(self) -> float:
        """Of the grid [m]."""
    @property
    def origin(self) -> tuple[float, float, float]:
        """Where vertex (0, 0, 0) lies [m]."""
    @property
    def nodes(self) -> NDArray[numpy.float64]:
        """(n, 3), on the surface [m]."""
    @property
    def node_areas(self) -> NDArray[numpy.float64]:
        """(n,) [m^2]."""
    @property
    def volume(self) -> float:
        """[m^3]"""
    @property
    def inertia(self) -> tuple[float, float, float]:
        """Principal moments over density [m^5]."""
    @property
    def bounding_radius(self) -> float:
        """[m]"""
    @property
    def descriptors(self) -> dict[str, float]:
        """Elongation, flatness, sphericity, convexity, roundness and the lengths behind them."""
    def sample(self, points: ArrayLike) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
        """Distance (n,) [m] and its gradient (n, 3) at points (n, 3) of the body frame; NaN outside the grid."""

class ShapeLibrary:
    """A library file. A shape is read when it is requested."""

    def __init__(self, path: _Path) -> None: ...
    @property
    def names(self) -> list[str]: ...
    def __len__(self) -> int: ...
    def __getitem__(self, place: int | str) -> Shape:
        """By its place, or by its name."""

def generate_shapes(
    count: int,
    *,
    seed: int = 1,
    median_diameter: float = 1e-3,
    roundness: float = 0.35,
    roughness: float = 0.025,
    voxels_per_diameter: float = 20.0,
    node_count: int | None = None,
) -> list[Shape]:
    """Sand-like grains, as `reckon grains generate` makes them."""

def shapes_from_meshes(
    files: Sequence[_Path],
    *,
    unit: float = 1.0,
    voxels_per_diameter: float = 20.0,
    node_count: int | None = None,
) -> list[Shape]:
    """Shapes from closed surfaces (STL, OBJ, PLY); `unit` is the length of the files' unit [m]."""

def save_shapes(shapes: Sequence[Shape], path: _Path) -> None:
    """Writes a shape library."""

class _Scene:
    def __init__(self, file: _Path) -> None: ...
    @staticmethod
    def from_text(text: str, directory: _Path, name: str) -> _Scene: ...
    @property
    def text(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def grain_count(self) -> int: ...
    def resolved(self) -> str: ...

class _Simulation:
    def __init__(self, scene: _Scene, communicator: int | None) -> None: ...
    def step(self, count: int = 1) -> None: ...
    def begin_next_stage(self) -> None: ...
    @property
    def time(self) -> float: ...
    @property
    def time_step(self) -> float: ...
    @property
    def planned_steps(self) -> int: ...
    @property
    def step_number(self) -> int: ...
    @property
    def stage(self) -> str | None: ...
    def measure(self) -> dict[str, Any]: ...
    def grains(self) -> dict[str, Any]: ...
    def contacts(self) -> dict[str, Any]: ...

def _run(
    scene: _Scene,
    folder: _Path,
    resume: bool,
    overwrite: bool,
    steps: int | None,
    progress: Callable[[int, int], None] | None,
    communicator: int | None,
) -> dict[str, Any]: ...
def _history(folder: _Path) -> tuple[list[str], list[list[str]]]: ...
def _steps(folder: _Path) -> list[int]: ...
def _holds_run(folder: _Path) -> bool: ...
def _verdict(folder: _Path) -> dict[str, Any]: ...
def _fields(folder: _Path, step: int) -> dict[str, Any]: ...
