#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   release.sh SOURCE_DIR BUILD_DIR CMAKE
# The release preset configures where there is no GoogleTest, and its sources compile together, several as one; without
# optimisation, for speed. The program and the Python package that come out start.
set -euo pipefail
source=$1 build=$2 cmake=$3
export CCACHE_BASEDIR=$source CCACHE_NOHASHDIR=true
command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache
mkdir -p "$build"
cd "$source"
{ "$cmake" --preset release -B "$build" -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON -DCMAKE_CXX_FLAGS_RELEASE=-O0 &&
  "$cmake" --build "$build"; } >"$build/log" 2>&1 </dev/null || { grep -B 1 -A 12 "error\|FAILED" "$build/log" | head -n 80; exit 1; }
"$build/apps/reckon/reckon" --version
if [[ -d $build/python/reckon ]]; then
  PYTHONPATH=$build/python /usr/bin/python3 -c 'import reckon; print("Python package", reckon.__version__)'
fi
