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
for program in pvpython Xvfb; do
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
# Debian's ParaView draws through X only; a screen in memory will do. It chooses a free number itself and tells it when
# it can be drawn on. That of xvfb-run guesses a number and keeps its key among the temporary files of others; where
# either is gone, ParaView aborts.
draw_on_new_screen() {
  local screen number code=0
  coproc screen_in_memory { exec Xvfb -displayfd 1 -noreset -nolisten tcp -screen 0 1600x1200x24 2>screen.log; }
  screen=$!
  if read -r number <&"${screen_in_memory[0]}"; then
    DISPLAY=:$number bash -e -c '
      pvpython scene.run/paraview/state.py state.png
      pvpython scene.run/paraview/state.py rank.png rank 0
      pvpython cell.run/paraview/state.py cell.png
      pvpython "$1" scene.run "$2" state.png rank.png cell.run cell.png' - "$here/check_run.py" "$ranks" || code=$?
  else
    code=134
  fi
  kill "$screen" 2>/dev/null || true
  wait "$screen" || true
  return "$code"
}

# The code of a signal means that the screen ended ParaView, not the files that it opened: try once
# more.
for attempt in 1 2 3; do
  code=0
  draw_on_new_screen || code=$?
  ((code >= 128)) || exit "$code"
  echo "ParaView ended with code $code in attempt $attempt; its screen said:"
  cat screen.log
  sleep 2
done
exit "$code"
