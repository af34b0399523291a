#!/usr/bin/env python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Times Debian's LAMMPS and YADE beside `reckon bench`, one after the other on one core.

    bench/peers/run.py --install                  installs Debian's lammps and yade first (as root)
    bench/peers/run.py --reckon build/release/apps/reckon/reckon --page docs/performance/peers.md

LAMMPS moves 10,000 settled spheres (gran/hooke/history). YADE moves 592 superellipsoids as level
sets with 279 and with 5,000 nodes each. Reckon runs its workloads `dense` (279 nodes) and
`dense-fine` (5,000 nodes). All of it is repeated `--rounds` times, in turn, and the fastest stretch
of each counts: other work on the machine only ever adds time. `--page` puts the table into a page,
between its two marks; without it the table is printed.
"""
import argparse
import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- begin of the table: bench/peers/run.py -->", "<!-- end of the table -->"


@dataclasses.dataclass
class Timing:
    """The fastest stretch so far."""

    code: str
    what: str
    grains: int
    nodes: str
    coordination: float
    ns: float  # a grain and step


def output_of(*command, **options):
    """What a command prints; the script ends with it where the command fails."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, env=environment, **options)
    if done.returncode != 0:
        sys.exit(f"run.py: {' '.join(map(str, command))} failed:\n{done.stdout[-2000:]}")
    return done.stdout


def lammps(size, folder):
    sides = (10, 4) if size == "small" else (20, 25)
    steps, settle = (200, 2000) if size == "small" else (2000, 60000)
    text = output_of("lmp", "-in", HERE / "spheres.lammps", "-log", "none", "-var", "side",
                     str(sides[0]), "-var", "layers", str(sides[1]), "-var", "settle", str(settle),
                     "-var", "steps", str(steps), cwd=folder)
    loops = [(float(s), int(n), int(atoms)) for s, n, atoms in re.findall(
        r"Loop time of (\S+) on 1 procs for (\d+) steps with (\d+) atoms", text)][1:]
    coordination = float(re.search(r"^coordination (\S+)", text, re.MULTILINE).group(1))
    best = min(1e9 * seconds / steps / atoms for seconds, steps, atoms in loops)
    return Timing("LAMMPS", "spheres, gran/hooke/history", loops[0][2], "–", coordination, best)


def yade(nodes, size, folder):
    grains = 64 if size == "small" else 592
    request = {"grains": grains, "nodes": nodes, "fraction": 0.5 if size == "small" else 0.62,
               "steps": 2 if size == "small" else (100 if nodes < 1000 else 10),
               "state": str(folder / f"yade-{grains}.json")}
    file = folder / "request.json"
    file.write_text(json.dumps(request), encoding="utf-8")
    text = output_of("yade", "-n", "-x", "-j1", HERE / "level_sets_yade.py", file, cwd=folder)
    result = json.loads(re.search(r"^RESULT (.*)$", text, re.MULTILINE).group(1))
    best = min(result["seconds"]) / request["steps"] / grains * 1e9
    return Timing("YADE", "superellipsoids, LevelSet", grains, f"{result['nodes']:,}",
                  result["coordination"], best)


def workload_timing(program, workload, size, folder):
    saved = folder / "saved"
    output_of(program, "bench", workload, "--size", size, "--no-plain", "--threads", "1", "--cache",
              folder, "--save", saved)
    result = json.loads(next(saved.glob(f"{workload}.*.json")).read_text(encoding="utf-8"))
    shutil.rmtree(saved)
    nodes = {"dense": "279", "dense-fine": "5,000"}[workload]
    return Timing("reckon", f"`{workload}`", result["grains"], nodes,
                  2 * result["per_grain_step"]["touching_pairs"],
                  result["near"]["ns_per_grain_step"])


def table(timings):
    ours = next(t for t in timings if t.what == "`dense`")
    sphere = next(t for t in timings if t.code == "LAMMPS")
    lines = ["| program | what it moves | grains | nodes a grain | contacts a grain | ns a grain and "
             "step | over `dense` | over a LAMMPS sphere |", "|---|---|---|---|---|---|---|---|"]
    for t in timings:
        lines.append(f"| {t.code} | {t.what} | {t.grains:,} | {t.nodes} | {t.coordination:.1f} | "
                     f"{t.ns:,.0f} | {t.ns / ours.ns:.2f} | {t.ns / sphere.ns:.1f} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--install", action="store_true", help="install LAMMPS and YADE, then go on")
    parser.add_argument("--reckon", default="build/release/apps/reckon/reckon", help="the program")
    parser.add_argument("--size", choices=["full", "small"], default="full", help="small: to try it")
    parser.add_argument("--rounds", type=int, default=2, help="how often everything is timed")
    parser.add_argument("--cache", type=pathlib.Path, help="folder that keeps packings")
    parser.add_argument("--page", type=pathlib.Path, help="page that gets the table")
    arguments = parser.parse_args()
    if arguments.install:
        subprocess.run(["apt-get", "install", "-y", "--no-install-recommends", "lammps", "yade"],
                       check=True)
    missing = [p for p in ("lmp", "yade", arguments.reckon) if shutil.which(p) is None]
    if missing:
        sys.exit(f"run.py: not found: {', '.join(missing)}. --install gets LAMMPS and YADE; "
                 "docs/performance.md says how to build reckon.")

    best = {}
    with tempfile.TemporaryDirectory() as temporary:
        folder = (arguments.cache or pathlib.Path(temporary)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        program = pathlib.Path(arguments.reckon).resolve()
        for turn in range(arguments.rounds):
            for name, measure in (
                    ("spheres", lambda: lammps(arguments.size, folder)),
                    ("dense", lambda: workload_timing(program, "dense", arguments.size, folder)),
                    ("coarse", lambda: yade(279, arguments.size, folder)),
                    ("dense-fine",
                     lambda: workload_timing(program, "dense-fine", arguments.size, folder)),
                    ("fine", lambda: yade(5000, arguments.size, folder))):
                timing = measure()
                print(f"round {turn + 1} of {arguments.rounds}: {timing.code}, {timing.what}, "
                      f"{timing.nodes} nodes: {timing.ns:,.0f} ns a grain and step",
                      file=sys.stderr, flush=True)
                if name not in best or timing.ns < best[name].ns:
                    best[name] = timing
    rows = table(list(best.values()))
    if arguments.page is None:
        print(rows)
        return
    text = arguments.page.read_text(encoding="utf-8")
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    arguments.page.write_text(f"{text[:begin]}\n{rows}\n{text[end:]}", encoding="utf-8")


if __name__ == "__main__":
    main()
