#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/scan/stones.sh DATA [RECKON]
# Settles three hundred of the crushed stones whose spherical-harmonic coefficients are in DATA/anm, scans them with 20, 30 and
# 40 voxels per diameter, makes avatars of the scans and compares them with the stones. The avatars of the finest scan are then
# relaxed and compressed from all sides. Everything is written below build/examples/scan-stones, in some ten minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
data=$(realpath "${1:?usage: examples/scan/stones.sh DATA [RECKON]}")
reckon=$(realpath "${2:-build/release/apps/reckon/reckon}")
work=build/examples/scan-stones
mkdir -p "$work"
cp examples/scan/stones.toml examples/scan/compress.toml "$work/"
cd "$work"
[[ -s aggregate57.h5 ]] || "$reckon" grains from-harmonics "$data"/anm/*.dat --unit mm \
  --degree-table "$data/FDOT-57-geom.dat" --voxels-per-diameter 80 -o aggregate57.h5
[[ -d stones.run ]] || "$reckon" run stones.toml
for voxel in 0.776mm 0.517mm 0.388mm; do
  "$reckon" grains scan stones.run --voxel $voxel --out "scan-$voxel"
  "$reckon" grains from-scan "scan-$voxel/volume.h5" --voxel $voxel --out "found-$voxel" --truth "scan-$voxel"
done
cp compress.toml found-0.388mm/
cd found-0.388mm
"$reckon" run relax.toml --overwrite
"$reckon" grains moved placement.csv relax.run
"$reckon" run compress.toml --overwrite
cd ..
/usr/bin/python3 ../../../examples/scan/table.py found-*/report.json
