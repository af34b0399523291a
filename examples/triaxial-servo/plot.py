# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the shear stage of one or more triaxial runs.

usage: plot.py PICTURE RUN[=LABEL]...
Stress ratio q/p and volumetric strain (dilation upwards) over axial strain.
"""
import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def shear_stage(run: str) -> dict[str, list[float]]:
    """The rows of a run's last stage, by column."""
    with open(Path(run) / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    last = rows[-1]["stage"]
    names = ("strain_z", "volumetric_strain", "deviator_Pa", "mean_stress_Pa")
    return {name: [float(row[name]) for row in rows if row["stage"] == last] for name in names}


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=(6, 6))
    for argument in sys.argv[2:]:
        run, _, label = argument.partition("=")
        curve = shear_stage(run)
        strain = [100 * e for e in curve["strain_z"]]
        top.plot(strain, [q / p for q, p in zip(curve["deviator_Pa"], curve["mean_stress_Pa"])], label=label or run)
        bottom.plot(strain, [-100 * v for v in curve["volumetric_strain"]])
    top.set_ylabel("stress ratio q/p")
    top.set_ylim(bottom=0)
    top.legend(frameon=False)
    bottom.set_ylabel("dilation [%]")
    bottom.set_xlabel("axial strain [%]")
    for axes in (top, bottom):
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(sys.argv[1], dpi=150)


if __name__ == "__main__":
    main()
