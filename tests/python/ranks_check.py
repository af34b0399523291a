# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""For mpirun: the processes of mpi4py run and step a scene to the same bits as a single process.

    ranks_check.py FOLDER      an empty folder for the files
"""
import pathlib
import sys

import numpy
from mpi4py import MPI

import reckon

comm = MPI.COMM_WORLD
folder = pathlib.Path(sys.argv[1])
if comm.rank == 0:
    reckon.save_shapes(reckon.generate_shapes(2, seed=5, voxels_per_diameter=12, node_count=60), folder / "sand.h5")
comm.barrier()
scene = reckon.Scene({
    "material": {"density": 2650, "friction": 0.5},
    "contact": {"law": "linear", "normal_stiffness": "50 N/m", "restitution": 0.1},
    "body": {"gravity": [0, 0, -9.81]},
    "grains": [{"library": "sand.h5",
                "fill": {"count": 27, "box": {"low": [0, 0, 0], "high": ["4 mm", "4 mm", "12 mm"]},
                         "velocity": [0, 0, -0.5]}}],
    "wall": [{"name": "box", "box": {"low": [0, 0, 0], "high": ["4 mm", "4 mm", "12 mm"], "open_top": True}}],
    "time": {"steps": 2500},
    "output": {"history_interval": 100, "fields_interval": 500},
}, folder)
together = reckon.Simulation(scene, comm)
together.step(2500)
grains = together.grains()
contacts = together.contacts()
reckon.run(scene, folder / "together", comm=comm)
if comm.rank == 0:
    alone = reckon.Simulation(scene)
    alone.step(2500)
    for name, column in alone.grains().items():
        numpy.testing.assert_array_equal(grains[name], column, name)
    numpy.testing.assert_array_equal(contacts["force"], alone.contacts()["force"])
    assert len(contacts["grain"]) > 5, "too few contacts to tell"
    reckon.run(scene, folder / "alone")
    histories = [(folder / name / "history.csv").read_bytes() for name in ("together", "alone")]
    assert histories[0] == histories[1]
    print(f"{comm.size} processes agree with one")
else:
    assert len(grains["id"]) == 0
