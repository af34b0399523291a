#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial-undrained/run.sh [RECKON]
# Makes the grains, runs the test, plots it where Python has matplotlib: below build/examples/triaxial-undrained.
. "$(dirname "$0")/../run_recipe.sh" "$@"
plot plot_history.py "$work/run" "$work/triaxial-undrained.png" mean_stress_Pa deviator_Pa \
  --stages 3 --labels "mean effective stress p [Pa]" "deviator q [Pa]"
