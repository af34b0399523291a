#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/aggregate57/run.sh DATA [RECKON]
# Makes avatars of the 64 grains whose spherical-harmonic coefficients are in DATA/anm, each cut at
# its degree in DATA/FDOT-57-geom.dat, and lets 500 of them settle in a cylinder. Everything is
# written below build/examples/aggregate57.
set -euo pipefail
cd "$(dirname "$0")/../.."
data=$(realpath "${1:?usage: examples/aggregate57/run.sh DATA [RECKON]}")
reckon=${2:-build/release/apps/reckon/reckon}
work=build/examples/aggregate57
mkdir -p "$work"
"$reckon" grains from-harmonics "$data"/anm/*.dat --unit mm \
  --degree-table "$data/FDOT-57-geom.dat" --voxels-per-diameter 20 -o "$work/aggregate57.h5"
cp examples/aggregate57/scene.toml "$work/"
"$reckon" run "$work/scene.toml" --out "$work/run" --overwrite
"$reckon" surfaces "$work/run"
