#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/direct-shear/run.sh [RECKON]
# Makes grains and the spheres of their volumes, shears both in the same way, finds the local strains,
# and plots where Python has matplotlib. Everything is written below build/examples/direct-shear.
RECIPE_SPHERES=yes
. "$(dirname "$0")/../run_recipe.sh" "$@"
for run in sand spheres; do "$reckon" analyse "$work/$run"; done
plot direct-shear/plot.py "$work/direct-shear.png" \
  "$work/sand=350 grains, 100 kPa" "$work/spheres=spheres of the same volumes"
plot plot_band.py "$work/sand" "$work/shear-plane.png" y
