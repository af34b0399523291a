# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
#
# Sourced by the run.sh of a recipe that is one scene of the usual fifty grains, with its arguments ([RECKON]):
# makes the grains and runs the scene below build/examples. Leaves the caller in the project's folder, with $work.
set -euo pipefail
cd "$(dirname "$0")"
recipe=$(basename "$PWD")
cd ../..
reckon=${1:-build/release/apps/reckon/reckon}
work=build/examples/$recipe
mkdir -p "$work"
cp "examples/$recipe/scene.toml" "$work/"
[[ -s $work/sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o "$work/sand.h5"
"$reckon" run "$work/scene.toml" --out "$work/run" --overwrite
