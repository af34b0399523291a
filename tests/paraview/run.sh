#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   run.sh RECKON WORK_FOLDER [MPIEXEC COUNT_FLAG]
# Makes a run with everything that ParaView can be shown, on two ranks where MPIEXEC is given, and opens it
# with ParaView's own Python: check_run.py. Exit code 77: skipped, there is no ParaView.
set -euo pipefail
reckon=$1 work=$2
shift 2
here=$(cd "$(dirname "$0")" && pwd)
for program in pvpython xvfb-run; do
  command -v "$program" >/dev/null ||
    { echo "skipped: needs $program (tools/install_dependencies.sh paraview)"; exit 77; }
done
rm -rf "$work"
mkdir -p "$work"
cd "$work"
"$reckon" grains generate --count 4 --seed 7 --d50 1.2mm --threads 1 -o grains.h5
cp "$here/scene.toml" .
ranks=1
launcher=()
if [[ $# -gt 0 ]]; then
  ranks=2
  launcher=("$1" "$2" "$ranks")
fi
"${launcher[@]}" "$reckon" run scene.toml --threads 1 --quiet
"$reckon" paraview scene.run
cp "$here/cell.toml" .
"$reckon" run cell.toml --threads 1 --quiet
"$reckon" paraview cell.run
# Debian's ParaView draws through X only; a screen in memory will do, one for all. It aborts (134) when the screen that
# it was given goes down at once, as it may where another program's has just ended.
for attempt in 1 2 3 4 5; do
  code=0
  xvfb-run -a -s "-screen 0 1600x1200x24" bash -e -c '
    pvpython scene.run/paraview/state.py state.png
    pvpython scene.run/paraview/state.py rank.png rank 0
    pvpython cell.run/paraview/state.py cell.png
    pvpython "$1" scene.run "$2" state.png rank.png cell.run cell.png' - "$here/check_run.py" "$ranks" || code=$?
  [[ $code == 134 ]] || exit "$code"
  echo "no screen in attempt $attempt"
  sleep 2
done
exit "$code"
