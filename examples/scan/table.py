# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/scan/table.py REPORT.json...
# The comparisons with the truth of `reckon grains from-scan --truth`, as a table.
import json
import sys

print("| voxels per diameter | found once | split | joined | volume | sizes | inertia | centre | surface | normals | recall | precision |")
print("|---|---|---|---|---|---|---|---|---|---|---|---|")
for t in sorted((json.load(open(name))["truth"] for name in sys.argv[1:]), key=lambda t: t["voxels_per_diameter"]):
    print(f"| {t['voxels_per_diameter']:.0f} | {t['found_once']} of {t['grains']} | {t['split']} | {t['joined']} "
          f"| {t['volume_error']:+.2%} | {t['volume_error_absolute']:.2%} | {t['inertia_error']:.2%} "
          f"| {t['center_error_voxels']:.2f} voxels | {t['surface_error_voxels']:.2f} voxels | {t['normal_error_degrees']:.2f}° "
          f"| {t['recall']:.1%} | {t['precision']:.1%} |")
