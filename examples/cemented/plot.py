# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the shear stage of cemented samples and of others.

usage: plot.py PICTURE RUN[=LABEL]...
Deviator, dilation and the share of intact bonds over axial strain. The curve of a sample ends where the sample has fallen apart
and carries less than a fifth of its peak. Prints the peak and the deviator at the end.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1]))
import curves


def curve(run: str, label: str) -> tuple:
    shear = curves.last_stage(run)
    strain, deviator = 100 * shear["strain_z"], 1e-3 * shear["deviator_Pa"]
    peak = int(np.argmax(deviator))
    fallen = (np.arange(len(strain)) > peak) & (deviator < 0.2 * deviator[peak])
    end = int(np.argmax(fallen)) if fallen.any() else len(strain)
    late = strain > 0.8 * strain[-1]
    rest = f"falls apart at {strain[end]:.2f} %" if fallen.any() else f"last fifth {deviator[late].mean():.0f} kPa"
    text = f"{label}: peak {deviator[peak]:.0f} kPa at {strain[peak]:.2f} %, {rest}"
    hold = np.full(len(strain), np.nan)
    if "bonds" in shear:
        set_at_first = shear["bonds"][0] + shear["broken_in_tension"][0] + shear["broken_in_shear"][0]
        hold = 100 * shear["bonds"] / set_at_first
        text += (
            f"; of {set_at_first:.0f} bonds {shear['bonds'][peak]:.0f} hold at the peak, {shear['bonds'][-1]:.0f} at the end; "
            f"{shear['broken_in_tension'][-1]:.0f} broke in tension, {shear['broken_in_shear'][-1]:.0f} in shear"
        )
    print(text)
    shown = (strain, deviator, -100 * shear["volumetric_strain"], hold)
    return tuple(values[:end] for values in shown)


if __name__ == "__main__":
    names = ["deviator q [kPa]", "dilation [%]", "bonds that hold [%]"]
    curves.plot_runs(__doc__, "axial strain [%]", names, curve)
