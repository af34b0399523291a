#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/hopper/run.sh [RECKON]
# Makes the grains, runs the test, plots it where Python has matplotlib: below build/examples/hopper.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=${1:-build/release/apps/reckon/reckon}
work=build/examples/hopper
mkdir -p "$work"
cp examples/hopper/scene.toml "$work/"
[[ -s $work/sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o "$work/sand.h5"
"$reckon" run "$work/scene.toml" --out "$work/run" --overwrite
if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
  /usr/bin/python3 examples/hopper/plot.py "$work/run" "$work/hopper.png"
fi
