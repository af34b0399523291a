#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial-servo/independence.sh [RECKON]
# The result of the test must not depend on the rate of strain, once it is low, and on the number of
# nodes on a grain. Runs the test at four rates and with three numbers of nodes below
# build/examples/independence, and plots both where Python has matplotlib.
# docs/verification/assemblies.md has the results.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=${1:-build/release/apps/reckon/reckon}
work=build/examples/independence
mkdir -p "$work"
for nodes in 100 300 1000; do
  [[ -s $work/nodes-$nodes.h5 ]] ||
    "$reckon" grains generate --count 50 --seed 7 --d50 1mm --nodes "$nodes" -o "$work/nodes-$nodes.h5"
done

# run NAME LIBRARY RATE: the shearing lasts until 18 % of strain at most.
run() {
  local duration
  duration=$(awk -v rate="$3" 'BEGIN { printf "%g ms", 180 / rate }')
  sed -e "s/\"sand.h5\"/\"$2\"/" -e "s/strain_rate = 5 /strain_rate = $3 /" \
    -e "s/duration = \"40 ms\"/duration = \"$duration\"/" examples/triaxial-servo/scene.toml >"$work/$1.toml"
  "$reckon" run "$work/$1.toml" --out "$work/$1" --threads 1 --overwrite
}
for rate in 80 20 5 2.5; do run "rate-$rate" nodes-300.h5 "$rate"; done
for nodes in 100 1000; do run "nodes-$nodes" "nodes-$nodes.h5" 5; done

if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
  plot() { /usr/bin/python3 examples/triaxial-servo/plot.py "$@"; }
  plot "$work/rates.png" "$work/rate-80=80 1/s" "$work/rate-20=20 1/s" "$work/rate-5=5 1/s" "$work/rate-2.5=2.5 1/s"
  plot "$work/nodes.png" "$work/nodes-100=100 nodes" "$work/rate-5=300 nodes" "$work/nodes-1000=1000 nodes"
  echo "plots: $work/rates.png $work/nodes.png"
fi
