#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial-servo/seeds.sh [RECKON]
# The scatter between samples: the test with eight seeds, which fill the box differently with the
# same shapes, and with the spheres of their volumes. Below build/examples/seeds; a table, and a
# plot where Python has matplotlib. docs/verification/assemblies.md has the results.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=${1:-build/release/apps/reckon/reckon}
work=build/examples/seeds
mkdir -p "$work"
[[ -s $work/sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o "$work/sand.h5"
[[ -s $work/spheres.h5 ]] || "$reckon" grains spheres "$work/sand.h5" -o "$work/spheres.h5"

# run KIND SEED
run() {
  local name=$1-$2
  sed -e "s/\"sand.h5\"/\"$1.h5\"/" -e "s/^seed = .*/seed = $2/" examples/triaxial-servo/scene.toml >"$work/$name.toml"
  "$reckon" run "$work/$name.toml" --out "$work/$name" --threads 1 --overwrite --json >"$work/$name.json"
}
for seed in 1 2 3 4 5 6 7 8; do
  run spheres "$seed" &
  run sand "$seed"
  wait $!
done
/usr/bin/python3 examples/triaxial-servo/seeds.py "$work" "$work/seeds.png"
