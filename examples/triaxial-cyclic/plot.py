# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots signed deviator and volume over the axial strain of a cyclic test, from its third stage on.

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
    first = curves.stage(columns, 2)  # ends where the cycles begin
    strain = first["axial_strain"][-1]
    volume = first["total_volumetric_strain"][-1]
    for number in sorted(set(columns["stage"])):
        if number <= 2:
            continue
        rows = curves.stage(columns, number)
        color = "tab:red" if number % 2 == 1 else "tab:blue"
        axial = 100 * (rows["axial_strain"] - strain)
        left.plot(axial, 1e-3 * rows["axial_deviator_Pa"], color=color)
        right.plot(axial, -100 * (rows["total_volumetric_strain"] - volume), color=color)
    left.set_ylabel("deviator q [kPa]")
    right.set_ylabel("dilation [%]")
    for axes in (left, right):
        axes.set_xlabel("axial strain [%]")
    curves.save(figure, sys.argv[2])


if __name__ == "__main__":
    main()
