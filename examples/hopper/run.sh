#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/hopper/run.sh [RECKON]
# Makes the grains, runs the test, plots it where Python has matplotlib: below build/examples/hopper.
. "$(dirname "$0")/../run_recipe.sh" "$@"
plot hopper/plot.py "$work/run" "$work/hopper.png"
