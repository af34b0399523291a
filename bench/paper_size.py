#!/usr/bin/env python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the triaxial test of Tan and Sitar (2024) costs here: 19,906 grains of 4772 nodes.

    bench/paper_size.py [RECKON] [--threads N] [--cache FOLDER]

Packs grains, each with memory of its own, and compresses them as in a triaxial test for at least a
thousand steps (`reckon bench triaxial-19906 --storage band`); then says how long the whole test
would take. The paper gives 50 h on 53 cores and, for another assembly on one core, 67,083 s for
1000 steps of 42,684 grains; both together make some 305,000 steps.
"""
import argparse
import json
import subprocess
import sys

PAPER_GRAINS = 19906
PAPER_HOURS = 50
PAPER_CORES = 53
PAPER_SECONDS_PER_GRAIN_STEP = 67083 / 1000 / 42684  # on one core


def measured(options):
    command = [options.reckon, "bench", "triaxial-19906", "--storage", "band", "--no-plain",
               "--json", "--threads", str(options.threads)]
    for name in ("cache", "grains"):
        if getattr(options, name):
            command += [f"--{name}", str(getattr(options, name))]
    found = subprocess.run(command, stdout=subprocess.PIPE, check=False)
    if found.returncode != 0:
        sys.exit(found.returncode)
    return json.loads(found.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("reckon", nargs="?", default="build/release/apps/reckon/reckon")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--cache", help="keeps the packing")
    parser.add_argument("--grains", type=int, help="fewer, to try it out")
    options = parser.parse_args()
    result = measured(options)
    grains = result["grains"]
    paper_core_hours = PAPER_HOURS * PAPER_CORES
    steps = paper_core_hours * 3600 / (PAPER_GRAINS * PAPER_SECONDS_PER_GRAIN_STEP)
    hours = steps * result["seconds_per_1000_steps"] / 1000 / 3600
    near = result["near"]
    print(f"{grains} grains on {result['machine']}, {options.threads} threads,"
          f" {near['steps']} steps measured")
    print(f"memory           {result['peak_resident_bytes'] / 1e9:.2f} GB at most,"
          f" {result['shape_bytes_per_grain'] / 1e3:.0f} kB of shape and"
          f" {result['contact_bytes_per_grain'] / 1e3:.0f} kB of contacts a grain")
    print(f"speed            {1000 / result['seconds_per_1000_steps']:.2f} steps a second,"
          f" {near['ns_per_grain_step']:.0f} ns a grain and step")
    if grains == PAPER_GRAINS:
        print(f"{steps:.0f} steps     {hours:.2f} h here, {PAPER_HOURS} h on {PAPER_CORES} cores in"
              f" the paper: {paper_core_hours / (hours * options.threads):.0f} times less of a core's time")


if __name__ == "__main__":
    main()
