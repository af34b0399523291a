#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   consumer.sh BUILD_DIR CMAKE COMPILER
# Installs into an empty folder, and builds and runs a project that uses only that folder.
set -euo pipefail
build=$1 cmake=$2 compiler=$3
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$cmake" --install "$build" --prefix "$work/prefix" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/prefix/bin/reckon" --version
cp -r "$here/consumer" "$work/project"
{ "$cmake" -S "$work/project" -B "$work/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_PREFIX_PATH="$work/prefix" && "$cmake" --build "$work/build"; } >"$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }
"$work/build/drop"
