#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   without_npm.sh SOURCE_DIR CMAKE
# Where npm is missing, CMake prints that the page of `reckon report` is left out, and configures
# the rest.
set -euo pipefail
source=$1 cmake=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$cmake" -S "$source" -B "$work" -DRECKON_BUILD_TESTS=OFF -DRECKON_NPM:FILEPATH= >"$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }
grep -q 'left out: it needs nodejs and npm' "$work/log" || { cat "$work/log"; exit 1; }
grep -rqF viewer_absent.cpp "$work" || { echo "nothing stands in for the page"; exit 1; }
