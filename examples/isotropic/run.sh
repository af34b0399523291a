#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/isotropic/run.sh [RECKON]
# Makes the grains, runs the test, plots it where Python has matplotlib: below build/examples/isotropic.
. "$(dirname "$0")/../run_recipe.sh" "$@"
plot plot_history.py "$work/run" "$work/isotropic.png" mean_stress_Pa void_ratio \
  --stages 2,3,4,5,6 --log-x --labels "mean stress [Pa]" "void ratio"
