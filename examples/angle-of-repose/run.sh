#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/angle-of-repose/run.sh [RECKON]
# Makes the grains, runs the test, plots it where Python has matplotlib: below build/examples/angle-of-repose.
. "$(dirname "$0")/../run_recipe.sh" "$@"
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  plot angle-of-repose/plot.py "$work/run" "$work/angle-of-repose.png"
fi
