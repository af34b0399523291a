#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   scan_chain.sh RECKON SOURCE_DIR
# Measured stones settle, are scanned and made into avatars again, all by commands: what comes out is compared with what was
# scanned, relaxed, and its statistics are matched. Exit code 77: skipped, the data are missing, or the component ct.
set -euo pipefail
reckon=$1 source=$2
data=$source/../shared/data/aggregate57
[[ -d $data ]] || { echo "skipped: needs $data"; exit 77; }
if "$reckon" grains from-scan none.h5 --voxel 1mm --out /dev/null 2>&1 | grep -q "component .ct"; then
  echo "skipped: built without the component ct"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$reckon" grains from-harmonics "$data"/anm/[A-D]-anm-0000[1-4].dat --unit mm \
  --degree-table "$data/FDOT-57-geom.dat" --voxels-per-diameter 24 --threads 2 -o aggregate57.h5
sed -e 's/count = 300/count = 30/' -e 's/113 mm/76 mm/g' "$source/examples/scan/stones.toml" > stones.toml
"$reckon" run stones.toml --threads 2
"$reckon" grains scan stones.run --voxel 0.55mm --beam-hardening 0.1 --threads 2 --out scan
"$reckon" grains from-scan scan/volume.h5 --voxel 0.55mm --truth scan --threads 2 --out found
/usr/bin/python3 - <<'CHECK'
import json

truth = json.load(open("found/report.json"))["truth"]
print(truth)
assert truth["grains"] == 30
assert truth["found_once"] >= 29 and truth["split"] <= 1 and truth["joined"] <= 1
assert truth["volume_error_absolute"] < 0.02
assert truth["true_contacts"] > 30
# Eight of the 52 contacts overlap by 0.05 to 0.2 voxels while the blurred gray values show a gap.
assert truth["recall"] >= 0.8 and truth["precision"] > 0.95
CHECK
cd found
"$reckon" run relax.toml --threads 2
"$reckon" grains moved placement.csv relax.run -o moved.csv
# The stones as they settled press on each other; the same scene pushes them apart. So do those of a table that is drawn
# together until stones stand a voxel and more deep in each other.
/usr/bin/python3 - <<'SQUEEZE'
rows = [line.strip().split(",") for line in open("../scan/placement.csv") if not line.startswith("#")]
with open("../scan/squeezed.csv", "w") as file:
    for row in rows:
        print(",".join(row[:1] + [str(0.98 * float(x)) for x in row[1:4]] + row[4:]), file=file)
SQUEEZE
sed 's/placement.csv/squeezed.csv/' relax.toml > ../scan/squeezed.toml
"$reckon" run ../scan/squeezed.toml --threads 2 --out ../scan/squeezed.run
"$reckon" grains moved ../scan/squeezed.csv ../scan/squeezed.run -o squeezed_moved.csv | tee squeezed.txt
cp relax.toml ../scan/
"$reckon" run ../scan/relax.toml --threads 2 --out ../scan/relax.run
"$reckon" grains moved ../scan/placement.csv ../scan/relax.run -o settled_moved.csv | tee moved.txt
"$reckon" grains generate --like library.h5 --count 20 --seed 1 --voxels-per-diameter 16 --threads 2 -o more.h5
"$reckon" grains statistics library.h5 -o library.csv
"$reckon" grains statistics more.h5 -o more.csv
/usr/bin/python3 - <<'CHECK'
import csv


def means(name):
    rows = list(csv.DictReader(open(name)))
    return {key: sum(float(row[key]) for row in rows) / len(rows) for key in rows[0] if key not in ("name", "grain")}


scanned, settled = means("moved.csv"), means("settled_moved.csv")
print(scanned, settled)
assert scanned["moved_diameters"] <= settled["moved_diameters"]
assert 0 < settled["moved_diameters"] < 0.02 and settled["turned_degrees"] < 2
deepest = lambda name: [float(line.split("by ")[1].split()[0]) for line in open(name) if "pairs overlap" in line]
squeezed = means("squeezed_moved.csv")
for name, least in (("moved.txt", 1e-5), ("squeezed.txt", 1e-4)):
    before, after = deepest(name)
    print(name, before, after)
    assert before > least and after < 3e-6, name
assert 0.005 < squeezed["moved_diameters"] < 0.05, squeezed
steps = int(list(csv.DictReader(open("../scan/squeezed.run/history.csv")))[-1]["step"])
assert 500 < steps < 50000, f"the stage ends when nothing overlaps, not after {steps} steps"
measured, made = means("library.csv"), means("more.csv")
for key, tolerance in (("diameter_m", 0.1), ("elongation", 0.08), ("flatness", 0.12), ("roundness", 0.1), ("convexity", 0.05)):
    print(key, measured[key], made[key])
    assert abs(made[key] / measured[key] - 1) < tolerance, key
CHECK
