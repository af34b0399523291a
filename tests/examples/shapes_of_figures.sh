#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   shapes_of_figures.sh RECKON
# The figures in the examples' pages come from runs with one library of fifty grains. Where another
# version makes other shapes of the same command, the figures are outdated, and this test fails.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" grains generate --count 50 --seed 7 --d50 1mm --threads 2 -o "$work/sand.h5" >/dev/null
shapes=$("$1" grains info "$work/sand.h5" --json | grep '"digest"' | sha256sum | cut -c 1-16)
documented=46ef64cae2cba460
[[ $shapes == "$documented" ]] || {
  echo "The generator makes other shapes ($shapes) than those of the examples' figures ($documented)."
  echo "If that is meant: run the examples' scripts anew, bring their pages, docs/verification/assemblies.md and the pictures"
  echo "up to date, then the line \`documented\` of this test."
  exit 1
}
