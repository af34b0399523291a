#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/scan/run.sh [RECKON]
# Settles five hundred known grains, scans them with 20, 30 and 40 voxels per diameter, makes avatars of the scans and compares
# them with the grains, as docs/verification/scan.md shows: below build/examples/scan, in about half an hour on two cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=$(realpath "${1:-build/release/apps/reckon/reckon}")
work=build/examples/scan
mkdir -p "$work"
cp examples/scan/scene.toml "$work/"
cd "$work"
[[ -s smooth.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm --roundness 0.55 --roundness-deviation 0.08 \
  --roughness 0.01 --highest-degree 10 --voxels-per-diameter 80 -o smooth.h5
[[ -d scene.run ]] || "$reckon" run scene.toml
for voxel in 50.8um 33.9um 25.4um; do
  "$reckon" grains scan scene.run --voxel $voxel --out "scan-$voxel"
  "$reckon" grains from-scan "scan-$voxel/volume.h5" --voxel $voxel --out "found-$voxel" --truth "scan-$voxel"
done
/usr/bin/python3 ../../../examples/scan/table.py found-*/report.json
