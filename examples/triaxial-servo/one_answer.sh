#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial-servo/one_answer.sh [RECKON [STEPS]]
# Presses the test's sample until it is dense, and from there makes STEPS steps on one thread, and
# again with threads, ranks, decompositions and lists that must not change a bit, and without the
# break. Prints for each what `reckon diff` found. docs/verification/determinism.md shows the table.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=$(realpath "${1:-build/release/apps/reckon/reckon}")
pressed=36000
steps=$((pressed + ${2:-3000}))
work=build/examples/one-answer
mkdir -p "$work"
cp examples/triaxial-servo/scene.toml "$work/scene.toml"
cd "$work"
[[ -s sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o sand.h5
"$reckon" run scene.toml --out pressed --threads 1 --steps "$pressed" --overwrite --quiet

# go_on NAME [SCENE LINES]: continues from there in a copy, with $launch and $threads.
go_on() {
  rm -rf "$1"
  cp -r pressed "$1"
  { cat scene.toml; printf '%s\n' "${2:-}"; } >"$1.toml"
  "${launch[@]}" "$reckon" run "$1.toml" --out "$1" --steps "$steps" --resume --quiet --threads "$threads"
}
different=0
compare() {
  local verdict
  verdict=$("$reckon" diff one "$1" | head -1) || different=1
  printf '| %s | %s |\n' "$2" "$verdict"
}
# variant NAME MEANING [SCENE LINES]
variant() {
  go_on "$1" "${3:-}"
  compare "$1" "$2"
}
launch=()
threads=1
go_on one
printf '| run | beside one thread |\n|---|---|\n'
for threads in 2 3 8; do variant "threads-$threads" "$threads threads"; done
threads=1
variant skin "lists that reach farther" $'[neighbor]\nskin = 0.3'
variant plain-instructions "without wide instructions" $'[neighbor]\nsimd = "scalar"'
if command -v mpirun >/dev/null; then
  for ranks in 2 3; do
    launch=(mpirun --oversubscribe -np "$ranks")
    for decomposition in balanced grid replicated; do
      variant "$decomposition-$ranks" "$ranks ranks, \`$decomposition\`" $'[parallel]\n'"decomposition = \"$decomposition\""
    done
  done
  launch=()
fi
"$reckon" run scene.toml --out whole --threads 2 --steps "$steps" --overwrite --quiet
compare whole "without the restart, 2 threads"
exit "$different"
