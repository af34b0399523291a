#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the checkpoints of the two legacy592 runs with the reference trajectories.

  compare.py WORK DATA TABLE.csv

WORK holds the run folders mu0 and mu065, DATA the reference files. Prints and writes, per run and
frame, the largest and the median distance of a grain from where the reference code has it [voxel],
and the largest difference of a quaternion's component.
"""
import pathlib
import sys

import h5py
import numpy as np

GRAINS = 592
FRAMES = (50, 100, 150, 200)  # the reference also holds step 0, the input


def reference(data, kind, name):
    """Frames of GRAINS rows each."""
    rows = np.loadtxt(data / f"reference_{kind}_{name}.dat")
    return rows.reshape(-1, GRAINS, rows.shape[1])


def main():
    work, data, table = (pathlib.Path(argument) for argument in sys.argv[1:4])
    lines = ["run,step,largest_distance,median_distance,largest_quaternion_difference"]
    for name in ("mu0", "mu065"):
        positions = reference(data, "positions", name)
        rotations = reference(data, "rotations", name)
        # The legacy order (a, b, c, d) is (w, x, y, z) = (d, -b, a, -c).
        quaternions = rotations[..., [3, 1, 0, 2]] * [1, -1, 1, -1]
        for frame, step in enumerate(FRAMES, start=1):
            path = work / name / "checkpoints" / f"step_{step:010d}.h5"
            with h5py.File(path, "r") as file:
                position = file["/grain/position"][:]
                orientation = file["/grain/orientation"][:]
            distance = np.linalg.norm(position - positions[frame], axis=1)
            sign = np.sign(np.sum(orientation * quaternions[frame], axis=1, keepdims=True))
            turn = np.abs(orientation * sign - quaternions[frame]).max()
            lines.append(f"{name},{step},{distance.max():.2e},{np.median(distance):.2e},{turn:.2e}")
    table.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
