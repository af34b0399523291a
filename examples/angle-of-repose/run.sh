#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/angle-of-repose/run.sh [RECKON]
# Makes the grains, runs the test, plots it where Python has matplotlib: below build/examples/angle-of-repose.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=${1:-build/release/apps/reckon/reckon}
work=build/examples/angle-of-repose
mkdir -p "$work"
cp examples/angle-of-repose/scene.toml "$work/"
[[ -s $work/sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o "$work/sand.h5"
"$reckon" run "$work/scene.toml" --out "$work/run" --overwrite
if /usr/bin/python3 -c 'import matplotlib, h5py' 2>/dev/null; then
  /usr/bin/python3 examples/angle-of-repose/plot.py "$work/run" "$work/angle-of-repose.png"
fi
