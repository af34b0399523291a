#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial-servo/run.sh [RECKON]
# Makes grains and the spheres of their volumes, runs the same test on both, and plots them where
# Python has matplotlib. Everything is written below build/examples/triaxial-servo.
RECIPE_SPHERES=yes
. "$(dirname "$0")/../run_recipe.sh" "$@"
plot triaxial-servo/plot.py "$work/triaxial-servo.png" \
  "$work/sand=500 grains, 100 kPa" "$work/spheres=spheres of the same volumes"
