#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   shapes_of_figures.sh RECKON SOURCE_DIR
# The figures of a page with a line "shapes of the figures: DIGEST" come from runs with the library of fifty grains of
# that digest. Where the program now makes other shapes of the same command, the page must say that its figures are of
# earlier shapes; where it makes the same, the page must not.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" grains generate --count 50 --seed 7 --d50 1mm --threads 2 -o "$work/sand.h5" >/dev/null
shapes=$("$1" grains info "$work/sand.h5" --json | grep '"digest"' | sha256sum | cut -c 1-16)
cd "$2"
mapfile -t pages < <(grep -rl --include='*.md' '^<!-- shapes of the figures: ' docs examples)
echo "shapes $shapes, ${#pages[@]} pages"
[[ ${#pages[@]} -gt 0 ]]
faults=0
for page in "${pages[@]}"; do
  notice=$(grep -c '^> \*\*Figures of earlier shapes\.\*\*' "$page" || true)
  if grep -q "^<!-- shapes of the figures: $shapes -->" "$page"; then
    [[ $notice == 0 ]] || { echo "$page: its figures are of these shapes: remove the notice of earlier shapes"; faults=1; }
  else
    [[ $notice == 1 ]] || { echo "$page: its figures are of other shapes: run its script anew, or add the notice"; faults=1; }
  fi
done
exit "$faults"
