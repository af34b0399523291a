#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial-cyclic/run.sh [RECKON]
# Makes the grains, runs the test, plots it where Python has matplotlib: below build/examples/triaxial-cyclic.
. "$(dirname "$0")/../run_recipe.sh" "$@"
plot triaxial-cyclic/plot.py "$work/run" "$work/triaxial-cyclic.png"
