#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   without_googletest.sh SOURCE_DIR CMAKE
# Where there is no GoogleTest, the release preset configures, and has what ./quickstart builds.
set -euo pipefail
source=$1 cmake=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$source"
"$cmake" --preset release -B "$work" -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$cmake" --build "$work" --target help >"$work/targets"
grep -q '^reckon: ' "$work/targets"
if grep -q 'Python package is left out' "$work/log"; then exit 0; fi
grep -q '^reckon_python: ' "$work/targets"
