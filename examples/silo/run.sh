#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/silo/run.sh [RECKON]
# Makes the grains, runs the test with the walls' friction and with half of it, plots both where Python has matplotlib:
# below build/examples/silo.
. "$(dirname "$0")/../run_recipe.sh" "$@"
sed 's/^friction = 0.3$/friction = 0.15/' "$work/scene.toml" >"$work/smoother.toml"
"$reckon" run "$work/smoother.toml" --out "$work/smoother" --overwrite
plot silo/plot.py 7.5e-3 "$work/silo.png" "$work/run=0.3" "$work/smoother=0.15"
