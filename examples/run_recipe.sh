# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
#
# Sourced by the run.sh of a recipe that is one scene of the usual fifty grains, with its arguments ([RECKON]):
# makes the grains and runs the scene below build/examples, as `run`. With RECIPE_SPHERES=yes before, it makes the spheres
# of their volumes too and runs the scene with both, as `sand` and `spheres`. Leaves the caller in the project's folder,
# with $reckon, $work and the function `plot`.
set -euo pipefail
cd "$(dirname "$0")"
recipe=$(basename "$PWD")
cd ../..
reckon=${1:-build/release/apps/reckon/reckon}
work=build/examples/$recipe
mkdir -p "$work"

# plot SCRIPT ARGUMENT...: a script of examples/, where Python has matplotlib.
plot() {
  if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then /usr/bin/python3 "examples/$1" "${@:2}"; fi
}

[[ -s $work/sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o "$work/sand.h5"
if [[ ${RECIPE_SPHERES:-no} == yes ]]; then
  [[ -s $work/spheres.h5 ]] || "$reckon" grains spheres "$work/sand.h5" -o "$work/spheres.h5"
  cp "examples/$recipe/scene.toml" "$work/sand.toml"
  sed 's/"sand.h5"/"spheres.h5"/' "$work/sand.toml" >"$work/spheres.toml"
  for run in sand spheres; do
    "$reckon" run "$work/$run.toml" --out "$work/$run" --overwrite
  done
else
  cp "examples/$recipe/scene.toml" "$work/"
  "$reckon" run "$work/scene.toml" --out "$work/run" --overwrite
fi
