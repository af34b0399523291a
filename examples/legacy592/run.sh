#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/legacy592/run.sh DATA [RECKON]
# Runs the scene without and with friction on the legacy files in DATA (morphologies.tar.xz,
# positions_s592.dat, rotations_s592.dat, accelerations_s592.dat), then compares with the reference
# trajectories there. Everything is written below build/examples/legacy592.
set -euo pipefail
cd "$(dirname "$0")/../.."
data=$(realpath "${1:?usage: examples/legacy592/run.sh DATA [RECKON]}")
reckon=${2:-build/release/apps/reckon/reckon}
work=build/examples/legacy592
mkdir -p "$work/morphologies"
tar -xJf "$data/morphologies.tar.xz" -C "$work/morphologies"
cp "$data"/{positions,rotations,accelerations}_s592.dat "$work/"
cp examples/legacy592/scene.toml "$work/mu0.toml"
sed -e 's/^friction = 0$/friction = 0.65/' -e 's/^# friction = 0.8 .*/friction = 0.8/' \
  -e 's/without friction/with friction/' examples/legacy592/scene.toml >"$work/mu065.toml"
for run in mu0 mu065; do
  "$reckon" run "$work/$run.toml" --out "$work/$run" --overwrite
done
/usr/bin/python3 examples/legacy592/compare.py "$work" "$data" "$work/comparison.csv"
