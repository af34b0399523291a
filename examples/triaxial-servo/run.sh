#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial-servo/run.sh [RECKON]
# Makes the grains, runs the test, and plots it where Python has matplotlib. Everything is written
# below build/examples/triaxial-servo.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=${1:-build/release/apps/reckon/reckon}
work=build/examples/triaxial-servo
mkdir -p "$work"
cp examples/triaxial-servo/scene.toml "$work/"
[[ -s $work/sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o "$work/sand.h5"
"$reckon" run "$work/scene.toml" --out "$work/run" --overwrite
if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
  /usr/bin/python3 examples/triaxial-servo/plot.py "$work/triaxial.png" "$work/run=500 grains, 100 kPa"
  echo "plot: $work/triaxial.png"
fi
