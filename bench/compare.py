#!/usr/bin/env python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares what `reckon bench --save` wrote with the tracked results, as ratios.

    bench/compare.py NEW [OLD]        files or folders; OLD is bench/results

One line per workload and machine that both have. The figure to watch is the ratio to the plain
algorithm, which was run beside it in the same process: times alone differ from day to day on a
machine that others use too. Exits with 1 when a ratio fell by more than the tolerance, or when
both engines did not end in the same bits.
"""
import argparse
import json
import pathlib
import sys


def results(path):
    """{(workload, machine, threads, size, storage): result} of a file or of all JSON files in a folder."""
    files = sorted(path.glob("*.json")) if path.is_dir() else [path]
    if not files:
        sys.exit(f"compare: {path} holds no results (*.json)")
    found = {}
    for file in files:
        try:
            result = json.loads(file.read_text(encoding="utf-8"))
            key = (*(result[k] for k in ("workload", "machine", "threads", "size")),
                   result.get("storage", "full"))
        except (OSError, ValueError, KeyError, TypeError) as error:
            sys.exit(f"compare: {file} is not a result of `reckon bench --save`: {error}")
        found[key] = result
    return found


def name_of(key):
    return key[0] if key[4] == "full" else f"{key[0]}, {key[4]}"


def compare(old, new, tolerance):
    """Prints a table; returns whether anything got worse."""
    worse = False
    print(f"{'workload':20} {'threads':>7} {'ns':>8} {'was':>8} {'times':>6}"
          f" {'plain/near':>11} {'was':>7} {'times':>6}")
    for key in sorted(old.keys() & new.keys()):
        before, after = old[key], new[key]
        ns = [r["near"]["ns_per_grain_step"] for r in (after, before)]
        line = f"{name_of(key):20} {key[2]:7} {ns[0]:8.0f} {ns[1]:8.0f} {ns[0] / ns[1]:6.2f}"
        if not after.get("same_bits", True):
            line += "   BITS DIFFER"
            worse = True
        elif "ratio" in after and "ratio" in before:
            change = after["ratio"] / before["ratio"]
            line += f" {after['ratio']:11.1f} {before['ratio']:7.1f} {change:6.2f}"
            if change < 1 - tolerance:
                line += "   slower"
                worse = True
        print(line)
    for key in sorted(new.keys() - old.keys()):
        print(f"{name_of(key):20} {key[2]:7} not yet measured on {key[1]}")
    return worse


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("new", type=pathlib.Path)
    parser.add_argument("old", type=pathlib.Path, nargs="?",
                        default=pathlib.Path(__file__).parent / "results")
    parser.add_argument("--tolerance", type=float, default=0.15,
                        help="how far a ratio may fall, as a share (0.15)")
    options = parser.parse_args()
    sys.exit(compare(results(options.old), results(options.new), options.tolerance))


if __name__ == "__main__":
    main()
