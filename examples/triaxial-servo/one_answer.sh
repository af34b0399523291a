#!/usr/bin/env bash
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
#
#   examples/triaxial-servo/one_answer.sh [RECKON [STEPS]]
# Runs the first steps of the test on one thread, then again with threads, ranks, decompositions, lists and a break that must
# not change a bit, and says of each what `reckon diff` found. docs/verification/determinism.md shows the table.
set -euo pipefail
cd "$(dirname "$0")/../.."
reckon=$(realpath "${1:-build/release/apps/reckon/reckon}")
steps=${2:-4000}
work=build/examples/one-answer
mkdir -p "$work"
cp examples/triaxial-servo/scene.toml "$work/scene.toml"
cd "$work"
[[ -s sand.h5 ]] || "$reckon" grains generate --count 50 --seed 7 --d50 1mm -o sand.h5
"$reckon" run scene.toml --out one --threads 1 --steps "$steps" --overwrite --quiet

different=0
compare() {
  local verdict
  verdict=$("$reckon" diff one "$1" | head -1) || different=1
  printf '| %s | %s |\n' "$2" "$verdict"
}
# variant NAME MEANING [SCENE LINES]: a run of its own name, by what stands in $launch.
variant() {
  { cat scene.toml; printf '%s\n' "${3:-}"; } >"$1.toml"
  "${launch[@]}" "$reckon" run "$1.toml" --out "$1" --steps "$steps" --overwrite --quiet "${threads[@]}"
  compare "$1" "$2"
}
printf '| run | beside one thread |\n|---|---|\n'
launch=()
for n in 2 3 8; do threads=(--threads "$n"); variant "threads-$n" "$n threads"; done
threads=(--threads 1)
variant skin "lists that reach farther" $'[neighbor]\nskin = 0.3'
variant plain-instructions "without wide instructions" $'[neighbor]\nsimd = "scalar"'
if command -v mpirun >/dev/null && "$reckon" run --help | grep -q mpirun; then
  for ranks in 2 3; do
    launch=(mpirun --oversubscribe -np "$ranks")
    for decomposition in balanced grid replicated; do
      variant "$decomposition-$ranks" "$ranks ranks, \`$decomposition\`" $'[parallel]\n'"decomposition = \"$decomposition\""
    done
  done
  launch=()
fi
"$reckon" run scene.toml --out broken --threads 1 --steps $((steps / 3)) --overwrite --quiet
"$reckon" run scene.toml --out broken --threads 2 --steps "$steps" --resume --quiet
compare broken "stopped after a third, gone on with 2 threads"
exit "$different"
