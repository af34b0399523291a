# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the vertical stress over the depth in silos, with Janssen's law and the weight above.

usage: plot.py WIDTH PICTURE RUN=WALL_FRICTION...
WIDTH of the square silo [m]. Means over the files of fields/ from the last quarter of a run. The vertical stress at a
height is the weight above it less what the walls carry of that. K, the stress on the walls over the vertical one, is
taken from the same run, so that Janssen's law has nothing left to fit.
"""
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves

GRAVITY = 9.81
LAYERS = 18


class Silo(NamedTuple):
    depth: np.ndarray  # below the surface, of the layers' ends
    stress: np.ndarray  # vertical, there
    density: float  # of the bulk
    ratio: float  # K
    mobilised: float  # friction on the walls over its limit
    on_floor: float  # force over weight


def wall_names(run: Path) -> list[str]:
    """In the order in which contacts count them."""
    return [name.removesuffix(":fx_N") for name in curves.history(run) if name.endswith(":fx_N")]


def measure(run: Path, width: float, friction: float) -> Silo:
    sides = {"silo.x-": 0, "silo.x+": 0, "silo.y-": 1, "silo.y+": 1}
    axis_of = np.array([sides.get(name, -1) for name in wall_names(run)])
    contact_files = sorted(run.glob("fields/contacts_*.vtp"))
    stresses, pushes, mobilised, on_floor = [], [], [], []
    for file in contact_files[-len(contact_files) // 4 :]:
        grains = curves.arrays(file.with_name(file.name.replace("contacts", "grains")))
        contacts = curves.arrays(file)
        mass, floor = grains["mass"], grains["wall_displacement"][-1, 2]
        height = grains["Points"][:, 2] - floor
        middle = (height > 5e-3) & (height < 25e-3)
        density = mass[middle].sum() / (width * width * 20e-3)
        surface = mass.sum() / (density * width * width)
        at_wall = contacts["with_wall"] != 0
        force, place = contacts["force"][at_wall], contacts["Points"][1::2][at_wall][:, 2] - floor
        axis = axis_of[contacts["partner"][at_wall]]
        side = axis >= 0
        push = np.abs(np.where(axis == 0, force[:, 0], force[:, 1]))[side]
        lift, place = force[side, 2], place[side]
        ends = np.linspace(0, surface, LAYERS + 1)
        above = [GRAVITY * mass[height > z].sum() - lift[place > z].sum() for z in ends]
        stresses.append(np.array(above) / width**2)
        pushes.append(np.histogram(place, ends, weights=push)[0] / (4 * width * (ends[1] - ends[0])))
        mobilised.append(lift.sum() / (friction * push.sum()))
        on_floor.append(force[~side, 2].sum() / (GRAVITY * mass.sum()))
    stress = np.mean(stresses, axis=0)
    ratio = np.mean(pushes, axis=0).sum() / (0.5 * (stress[1:] + stress[:-1])).sum()
    return Silo(surface - ends, stress, density, ratio, float(np.mean(mobilised)), float(np.mean(on_floor)))


def main() -> None:
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    width = float(sys.argv[1])
    figure, axes = curves.plt.subplots(figsize=(6, 4.5))
    for number, (run, label) in enumerate(curves.runs_and_labels(sys.argv[3:])):
        friction = float(label)
        silo = measure(Path(run), width, friction)
        length = width / (4 * friction * silo.ratio)
        weight = silo.density * GRAVITY * silo.depth
        law = silo.density * GRAVITY * length * (1 - np.exp(-silo.depth / length))
        colour = f"C{number}"
        axes.plot(1e3 * silo.depth, silo.stress, "o", color=colour, label=f"measured, wall friction {friction:g}")
        axes.plot(1e3 * silo.depth, law, color=colour, label=f"Janssen, K = {silo.ratio:.2f}")
        print(
            f"wall friction {friction:g}: {100 * silo.mobilised:.1f} % of it mobilised, K = {silo.ratio:.2f}; the floor"
            f" carries {100 * silo.on_floor:.1f} % of the weight, {100 * law[0] / weight[0]:.1f} % after Janssen"
        )
    axes.plot(1e3 * silo.depth, weight, "k--", label="weight above")
    axes.set_xlabel("depth [mm]")
    axes.set_ylabel("vertical stress [Pa]")
    axes.set_xlim(left=0)
    axes.set_ylim(0, 2.2 * max(axes.lines[-3].get_ydata()))
    axes.legend(frameon=False)
    curves.save(figure, sys.argv[2])


if __name__ == "__main__":
    main()
