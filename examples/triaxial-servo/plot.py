# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the shear stage of one or more triaxial runs.

usage: plot.py PICTURE RUN[=LABEL]...
Stress ratio q/p and volumetric strain (dilation upwards) over axial strain.
"""
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves


def shear_curves(run: str | Path) -> tuple:
    """Axial strain [%], stress ratio and dilation [%] of the last stage of a run."""
    shear = curves.last_stage(run)
    ratio = shear["deviator_Pa"] / shear["mean_stress_Pa"]
    return 100 * shear["strain_z"], ratio, -100 * shear["volumetric_strain"]


if __name__ == "__main__":
    names = ["stress ratio q/p", "dilation [%]"]
    curves.plot_runs(__doc__, "axial strain [%]", names, lambda run, _label: shear_curves(run))
