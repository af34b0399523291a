# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Superellipsoids as level sets in YADE: compressed by six walls, then timed. Run by YADE itself:

    yade -n -x -j1 bench/peers/level_sets_yade.py REQUEST.json

The request holds `grains`, `nodes`, `fraction` (solid, where the timing begins), `steps` (of each of
three timed stretches) and `state`: a file that keeps the compressed assembly. If it exists, the
assembly is read from it instead of being compressed anew; the number of nodes may differ. Prints one
line RESULT with JSON.
"""
import json
import math
import os
import random
import sys
import time

from yade import *  # noqa: F403 (the way in which YADE's scripts get its names)
from yade import utils

with open(sys.argv[-1], encoding="utf-8") as file:
    request = json.load(file)
grains = request["grains"]

DISTANCE = 2.3e-3  # of neighbours at the start: no two grains touch in any orientation [m]
SPEED = 0.1  # of the walls along the longest side [m/s]
random.seed(1)
O.materials.append(FrictMat(young=1e6, poisson=0.3, density=2650, frictionAngle=0.5, label="grain"))


def add_grain(position, orientation):
    O.bodies.append(utils.levelSetBody(
        "superellipsoid", center=position, orientation=orientation, extents=(1e-3, 0.8e-3, 0.7e-3),
        epsilons=(0.8, 0.9), spacing=1e-4, nSurfNodes=request["nodes"], nodesPath=2, material="grain"))


side = math.ceil(grains ** (1 / 3))
kept = os.path.exists(request["state"])
if kept:
    with open(request["state"], encoding="utf-8") as file:
        state = json.load(file)
    for position, turn in state["grains"]:
        add_grain(position, Quaternion(Vector3(turn[:3]), turn[3]))
    planes = state["planes"]
else:
    for n in range(grains):
        axis = Vector3([random.gauss(0, 1) for _ in range(3)]).normalized()
        add_grain([DISTANCE * (0.5 + k) for k in (n % side, n // side % side, n // side**2)],
                  Quaternion(axis, random.uniform(0, math.pi)))
    planes = [[0, DISTANCE * side], [0, DISTANCE * side], [0, DISTANCE * math.ceil(grains / side**2)]]

solid = sum(body.shape.volume() for body in O.bodies)
lengths = [high - low for low, high in planes]
walls = []
for axis in range(3):
    for sign, at in zip((1, -1), planes[axis]):
        wall = O.bodies[O.bodies.append(utils.wall(at, axis=axis, sense=0, material="grain"))]
        velocity = Vector3(0, 0, 0)
        velocity[axis] = sign * SPEED * lengths[axis] / max(lengths)
        wall.state.vel = velocity
        walls.append(wall)

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_LevelSet_Aabb(), Bo1_Wall_Aabb()], verletDist=2e-5),
    InteractionLoop([Ig2_LevelSet_LevelSet_ScGeom(), Ig2_Wall_LevelSet_ScGeom()],
                    [Ip2_FrictMat_FrictMat_FrictPhys()],
                    [Law2_ScGeom_FrictPhys_CundallStrack(sphericalBodies=False)]),
    NewtonIntegrator(damping=0.4, gravity=(0, 0, 0)),
]
O.dt = 1e-5


def planes_now():
    return [[walls[2 * axis + k].state.pos[axis] for k in (0, 1)] for axis in range(3)]


def fraction_now():
    return solid / math.prod(high - low for low, high in planes_now())


while not kept and fraction_now() < request["fraction"]:
    O.run(20, True)
for wall in walls:
    wall.state.vel = Vector3(0, 0, 0)
if not kept:
    poses = [[list(body.state.pos), [*body.state.ori.toAxisAngle()[0], body.state.ori.toAxisAngle()[1]]]
             for body in O.bodies if isinstance(body.shape, LevelSet)]
    with open(request["state"], "w", encoding="utf-8") as file:
        json.dump({"grains": poses, "planes": planes_now()}, file)

O.run(2, True)  # lists and first contacts
times = []
for _ in range(3):
    start = time.perf_counter()
    O.run(request["steps"], True)
    times.append(time.perf_counter() - start)
touching = sum(1 for i in O.interactions
               if i.isReal and isinstance(O.bodies[i.id1].shape, LevelSet)
               and isinstance(O.bodies[i.id2].shape, LevelSet))
print("RESULT", json.dumps({"seconds": times, "nodes": len(O.bodies[0].shape.surfNodes),
                            "coordination": 2 * touching / grains}), flush=True)
