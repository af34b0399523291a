# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots deviator over axial strain of a cyclic test, strain added up over its stages from the third on.

usage: plot.py RUN PICTURE
"""
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves


def main() -> None:
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    columns = curves.history(sys.argv[1])
    figure, (left, right) = curves.plt.subplots(1, 2, figsize=(9, 4))
    strain = volume = 0.0  # when a stage begins
    for number in sorted(set(columns["stage"])):
        if number <= 2:
            continue
        rows = curves.stage(columns, number)
        color = "tab:red" if number % 2 == 1 else "tab:blue"
        axial = 100 * (strain + rows["strain_z"])
        left.plot(axial, 1e-3 * rows["deviator_Pa"], color=color)
        right.plot(axial, -100 * (volume + rows["volumetric_strain"]), color=color)
        strain += rows["strain_z"][-1]
        volume += rows["volumetric_strain"][-1]
    left.set_ylabel("deviator q [kPa]")
    right.set_ylabel("dilation [%]")
    for axes in (left, right):
        axes.set_xlabel("axial strain [%]")
    curves.save(figure, sys.argv[2])


if __name__ == "__main__":
    main()
