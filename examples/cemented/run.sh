#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/cemented/run.sh [RECKON]
# Makes the grains, shears them cemented, the same sample without cement, and the cemented one without support from its sides;
# plots them where Python has matplotlib. Everything is written below build/examples/cemented.
. "$(dirname "$0")/../run_recipe.sh" "$@"
sed '/^\[bond\]/,/^$/d; /^bond = true/d' "$work/scene.toml" >"$work/loose.toml"
sed '/^name = "shear"/,$ s/"50 kPa" }/0, rate_limit = 20 }/g' "$work/scene.toml" >"$work/unconfined.toml"
for run in loose unconfined; do
  "$reckon" run "$work/$run.toml" --out "$work/$run" --overwrite
done
plot cemented/plot.py "$work/cemented.png" \
  "$work/run=cemented, 50 kPa" "$work/loose=without cement, 50 kPa" "$work/unconfined=cemented, unconfined"
