#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/simple-shear/run.sh [RECKON]
# Makes the grains, runs the test, plots it where Python has matplotlib: below build/examples/simple-shear.
. "$(dirname "$0")/../run_recipe.sh" "$@"
plot simple-shear/plot.py "$work/simple-shear.png" "$work/run"
