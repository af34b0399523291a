#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   run_example.sh NAME RECKON SOURCE_DIR
# Runs an example's own scene for a few hundred steps in a temporary folder. Exit code 77: skipped,
# its data are missing.
set -euo pipefail
name=$1 reckon=$2 source=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
data=$source/../shared/data/$name
case "$name" in
  settle | triaxial | triaxial-* | oedometer | isotropic | direct-shear | cemented | simple-shear | angle-of-repose | hopper | silo)
    "$reckon" grains generate --count 4 --seed 7 --d50 1mm --threads 2 -o "$work/sand.h5" ;;
  aggregate57)
    [[ -d $data ]] || { echo "skipped: needs $data"; exit 77; }
    "$reckon" grains from-harmonics "$data"/anm/[AB]-anm-0000[12].dat --unit mm \
      --degree-table "$data/FDOT-57-geom.dat" --voxels-per-diameter 16 --threads 2 \
      -o "$work/aggregate57.h5" ;;
  legacy592)
    [[ -d $data ]] || { echo "skipped: needs $data"; exit 77; }
    mkdir "$work/morphologies"
    tar -xJf "$data/morphologies.tar.xz" -C "$work/morphologies"
    cp "$data"/*_s592.dat "$work/" ;;
esac
cp "$source/examples/$name/scene.toml" "$work/"
cd "$work"
"$reckon" check scene.toml --threads 2
"$reckon" run scene.toml --threads 2 --steps 100
[[ -s scene.run/history.csv && -s scene.run/grains.pvd ]]
"$reckon" surfaces scene.run
"$reckon" analyse scene.run --from 0
"$reckon" run scene.toml --threads 1 --steps 100 --out one_thread
"$reckon" diff scene.run one_thread | grep bit-identical
