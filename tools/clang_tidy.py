#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs clang-tidy over every unit of a build folder, skipping units without findings that are unchanged.

    tools/clang_tidy.py BUILD_FOLDER

A unit is one source, or several in a unity build, where clang-tidy reads their headers once. It is
clean for good as long as nothing that the result depends on changes: its own text, the sources and
headers that its object was built from, its compile command, the .clang-tidy files, and the version
of the tool. The hashes of clean units are kept in the user's cache folder, so that a fresh clone
profits too. The build folder must have been built, since the headers come from Ninja's records.
"""
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")


def headers_by_object(build):
    """The sources of each object, from the records of Ninja."""
    lines = subprocess.run(["ninja", "-C", build, "-t", "deps"], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    headers, current = collections.defaultdict(list), None
    for line in lines:
        if line.startswith("    "):
            headers[current].append(line.strip())
        elif ": #deps" in line:
            current = line.split(": #deps")[0]
    return headers


def settings():
    """The .clang-tidy files of the project."""
    return subprocess.run(["git", "ls-files", "*.clang-tidy"], cwd=ROOT, check=True,
                          capture_output=True, text=True).stdout.splitlines()


class Fingerprints:
    """Hashes of everything that the result of a source depends on."""

    def __init__(self, build):
        self.build = build
        self.headers = headers_by_object(build)
        self.known = {}
        common = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True).stdout
        for name in settings():
            common += (ROOT / name).read_bytes()
        self.common = common

    def of_file(self, path):
        """Project files by content; system headers by date, since packages replace them as a whole."""
        if path not in self.known:
            full = (self.build / path).resolve()
            if full.is_relative_to(ROOT):
                # A unity source includes others by their full path.
                text = full.read_bytes().replace(str(ROOT).encode(), b"")
                self.known[path] = hashlib.sha256(text).digest()
            else:
                self.known[path] = f"{full} {full.stat().st_mtime_ns}".encode()
        return self.known[path]

    def of_entry(self, entry):
        output = entry.get("output") or entry["command"].split(" -o ")[1].split()[0]
        digest = hashlib.sha256(self.common)
        digest.update(entry["command"].replace(str(ROOT), "").encode())
        for path in [entry["file"]] + self.headers.get(output, []):
            digest.update(self.of_file(path))
        return digest.hexdigest()


def mirror_settings(build):
    """Unity sources lie in the build folder. They need the .clang-tidy of the folder they come from."""
    for name in settings():
        copy = build / name
        if copy.parent != build and copy.parent.is_dir():
            shutil.copyfile(ROOT / name, copy)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    mirror_settings(build)
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    fingerprints = Fingerprints(build)
    cache = CACHE / "reckon" / "clang-tidy"
    cache.mkdir(parents=True, exist_ok=True)

    waiting = {}
    for entry in entries:
        source = pathlib.Path(entry["file"])
        if source.is_relative_to(build) and not source.name.startswith("unity_"):
            continue  # generated
        stamp = cache / fingerprints.of_entry(entry)
        if not stamp.exists():
            waiting[source] = stamp

    def tidy(source):
        done = subprocess.run(["clang-tidy", "-p", build, "--quiet", source], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if done.returncode == 0:
            waiting[source].touch()
        return source, done

    faulty = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, done in pool.map(tidy, sorted(waiting)):
            if done.returncode != 0:
                faulty += 1
                print(f"{source.relative_to(ROOT)}:\n{done.stdout}", flush=True)
    print(f"{len(entries)} units: {len(entries) - len(waiting)} known to be clean, "
          f"{len(waiting)} looked at, {faulty} with complaints")
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main())
