#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Makes every table and plot of docs/performance/scaling.md.
#
#   bench/scaling/run.sh [--counted | --measured] [BUILD]
#
# BUILD is a folder with a release build (build/release by default). --counted makes only the tables
# that do not depend on the machine, a minute; --measured only those that do, some ten minutes on a
# machine that is otherwise idle. Without either, both.
set -euo pipefail
cd "$(dirname "$0")/../.."

counted=true
measured=true
case "${1:-}" in
  --counted) measured=false; shift ;;
  --measured) counted=false; shift ;;
esac
build=${1:-build/release}
bench=$build/bench/scaling/reckon_bench_scaling
packings=$build/bench/scaling/packings  # made once, then read
tables=docs/performance/scaling
[[ -x $bench ]] || { echo "$bench is missing; cmake --build ${build} --target reckon_bench_scaling" >&2; exit 1; }
mkdir -p "$packings" "$tables"

# One program on RANKS ranks with THREADS threads each. Who waits keeps asking while there is a core
# for everybody, which is fastest; else it makes room. WAIT=passive makes room always: for a machine
# that others use too.
on_ranks() {
  local ranks=$1 threads=$2
  shift 2
  local options=(--oversubscribe --bind-to none)
  [[ $(id -u) -eq 0 ]] && options+=(--allow-run-as-root)
  local wait=${WAIT:-active} yield=0
  ((ranks * threads > $(nproc))) && wait=passive
  [[ $wait == passive ]] && yield=1
  OMP_WAIT_POLICY=$wait OMPI_MCA_mpi_yield_when_idle=$yield \
    OMPI_MCA_btl_vader_single_copy_mechanism=none \
    mpirun "${options[@]}" -np "$ranks" "$bench" --threads "$threads" "$@"
}

if $counted; then
  few=1,2,4,8,16,32,64
  many=1,2,4,8,16,32,64,128,256,512
  "$bench" bins >"$tables/bins.csv"
  "$bench" count paper --grains 592 --edge 200 --ranks $few >"$tables/paper-592.csv"
  "$bench" count paper --grains 1998 --edge 300 --ranks $few >"$tables/paper-1998.csv"
  "$bench" count paper --grains 4736 --edge 400 --ranks $few >"$tables/paper-4736.csv"
  "$bench" count paper --grains 42684 --edge 600 \
    --ranks 1,2,4,6,8,12,16,18,24,27,32,36,48,54,64,72,96,108,144,216 >"$tables/paper-42684.csv"
  for assembly in cube heap; do
    "$bench" count $assembly --grains 4096 --ranks $few >"$tables/$assembly-4096.csv"
    "$bench" count $assembly --grains 42684 --ranks $many >"$tables/$assembly-42684.csv"
  done
  "$bench" count squeezed --grains 4096 --ranks $few --cache "$packings" \
    >"$tables/squeezed-4096.csv"
  "$bench" weak >"$tables/weak.csv"
fi

if $measured; then
  repeats=${REPEATS:-3}
  table=$tables/measured.csv
  "$bench" columns >"$table.tmp"
  for grains in 592 1998 4736; do
    for layout in 1x1 1x2 2x1 2x2 4x1; do
      for decomposition in balanced grid; do
        [[ $layout == 1x* && $decomposition == grid ]] && continue
        for ((repeat = 0; repeat < repeats; ++repeat)); do
          on_ranks "${layout%x*}" "${layout#*x}" measure "paper-$grains" \
            --decomposition $decomposition --cache "$packings" >>"$table.tmp"
        done
      done
    done
  done
  mv "$table.tmp" "$table"
fi

/usr/bin/python3 -B bench/scaling/plot_scaling.py "$tables" docs/images
