#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial-servo/run.sh [RECKON]
# Makes grains and the spheres of their volumes, runs the same test on both, and plots them where
# Python has matplotlib. Everything is written below build/examples/triaxial-servo.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=${1:-build/release/apps/reckon/reckon}
work=build/examples/triaxial-servo
mkdir -p "$work"
[[ -s $work/sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o "$work/sand.h5"
[[ -s $work/spheres.h5 ]] || "$reckon" grains spheres "$work/sand.h5" -o "$work/spheres.h5"
cp examples/triaxial-servo/scene.toml "$work/sand.toml"
sed 's/"sand.h5"/"spheres.h5"/' "$work/sand.toml" >"$work/spheres.toml"
for run in sand spheres; do
  "$reckon" run "$work/$run.toml" --out "$work/$run" --overwrite
done
if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
  /usr/bin/python3 examples/triaxial-servo/plot.py "$work/triaxial.png" \
    "$work/sand=500 grains, 100 kPa" "$work/spheres=spheres of the same volumes"
  echo "plot: $work/triaxial.png"
fi
