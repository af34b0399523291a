#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/oedometer/run.sh [RECKON]
# Makes the grains, runs the test, plots it where Python has matplotlib: below build/examples/oedometer.
. "$(dirname "$0")/../run_recipe.sh" "$@"
plot plot_history.py "$work/run" "$work/oedometer.png" stress_zz_Pa void_ratio \
  --stages 2,3 --log-x --labels "axial stress [Pa]" "void ratio"
