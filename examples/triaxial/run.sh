#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial/run.sh [RECKON] [small|large]
# Grains and the spheres of their volumes at 50, 100 and 200 kPa: six tests, 350 grains each (small) or
# 1800 (large), and plots where Python has matplotlib, beside the laboratory's curves of Dobrany sand
# where they are (../shared/data/dobrany-sand). Everything is written below build/examples/triaxial.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=${1:-build/release/apps/reckon/reckon}
size=${2:-small}
work=build/examples/triaxial/$size
mkdir -p "$work"
export OMP_WAIT_POLICY=passive
[[ -s $work/sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o "$work/sand.h5"
[[ -s $work/spheres.h5 ]] || "$reckon" grains spheres "$work/sand.h5" -o "$work/spheres.h5"

larger=()
if [[ $size == large ]]; then
  larger=(-e 's/count = 350/count = 1800/; s/"3.5 mm"/"5.25 mm"/g; s/"250 mm"/"520 mm"/g')
fi
# The rate grows with the root of the pressure: the same inertial number.
while read -r kpa rate duration; do
  for grains in sand spheres; do
    sed "${larger[@]}" -e "s/sand.h5/$grains.h5/; s/100 kPa/$kpa kPa/g; s/strain_rate = 5/strain_rate = $rate/" \
      -e "s/\"30 ms\"/\"$duration ms\"/" examples/triaxial/scene.toml >"$work/$grains-$kpa.toml"
    "$reckon" run "$work/$grains-$kpa.toml" --out "$work/$grains-$kpa" --overwrite | tee "$work/$grains-$kpa.txt"
    "$reckon" run "$work/$grains-$kpa.toml" --out "$work/$grains-$kpa" --resume --json >"$work/$grains-$kpa.json"
  done
done <<'END'
100 5 30
50 3.5 42.86
200 7 21.43
END
"$reckon" analyse "$work/sand-100"
if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
  /usr/bin/python3 examples/triaxial/table.py "$work"
  /usr/bin/python3 examples/triaxial/plot.py "$work" "$work/triaxial.png"
  /usr/bin/python3 examples/plot_band.py "$work/sand-100" "$work/shear-band.png"
fi
