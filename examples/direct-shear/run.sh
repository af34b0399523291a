#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/direct-shear/run.sh [RECKON]
# Makes grains and the spheres of their volumes, shears both in the same way, finds the local strains,
# and plots where Python has matplotlib. Everything is written below build/examples/direct-shear.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=${1:-build/release/apps/reckon/reckon}
work=build/examples/direct-shear
mkdir -p "$work"
[[ -s $work/sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o "$work/sand.h5"
[[ -s $work/spheres.h5 ]] || "$reckon" grains spheres "$work/sand.h5" -o "$work/spheres.h5"
cp examples/direct-shear/scene.toml "$work/sand.toml"
sed 's/"sand.h5"/"spheres.h5"/' "$work/sand.toml" >"$work/spheres.toml"
for run in sand spheres; do
  "$reckon" run "$work/$run.toml" --out "$work/$run" --overwrite
  "$reckon" analyse "$work/$run"
done
if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
  /usr/bin/python3 examples/direct-shear/plot.py "$work/direct-shear.png" \
    "$work/sand=350 grains, 100 kPa" "$work/spheres=spheres of the same volumes"
  /usr/bin/python3 examples/plot_band.py "$work/sand" "$work/shear-plane.png" y
  echo "plot: $work/direct-shear.png"
fi
