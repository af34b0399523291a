# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Sand Reckoner from Python: make shapes and scenes, step a simulation, read what runs wrote.

Quantities are in SI units; arrays are NumPy's. Whatever goes wrong is a `reckon.Error` with the text that the
command line would print.

    import reckon
    reckon.save_shapes(reckon.generate_shapes(20, seed=7), "sand.h5")
    scene = reckon.Scene.from_file("scene.toml").changed({"material.friction": 0.3})
    run = reckon.run(scene, "low-friction")
    print(run.history["time_s"], run.history["unbalanced_ratio"])
"""
import os

# Waiting threads of GNU's OpenMP, which reads this when it is loaded, else spin for milliseconds: see `reckon`'s main.
if "OMP_WAIT_POLICY" not in os.environ:
    os.environ.setdefault("GOMP_SPINCOUNT", "1000")
# It ends the program if the system refuses to start as many threads as this requests.
_MOST_THREADS = 1024
_threads = os.environ.get("OMP_NUM_THREADS", "").split(",")[0].strip()
if _threads.isdigit() and int(_threads) > _MOST_THREADS:
    os.environ["OMP_NUM_THREADS"] = str(_MOST_THREADS)

from ._reckon import (  # noqa: E402
    Error,
    Shape,
    ShapeLibrary,
    __version__,
    generate_shapes,
    save_shapes,
    set_threads,
    shapes_from_meshes,
    threads,
)
from .runs import InvalidRunWarning, Run, run  # noqa: E402
from .scenes import Scene, Simulation  # noqa: E402

__all__ = [
    "Error",
    "InvalidRunWarning",
    "Run",
    "Scene",
    "Shape",
    "ShapeLibrary",
    "Simulation",
    "__version__",
    "generate_shapes",
    "run",
    "save_shapes",
    "set_threads",
    "shapes_from_meshes",
    "threads",
]
