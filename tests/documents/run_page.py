#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Follows a page of the manual word for word.

  run_page.py PAGE RECKON FOLDER [--small]

In the order of the page, a block ```toml whose first line is a comment with a file name (# settle.toml) is written
to that file, and each block ```sh is run by bash in FOLDER, with RECKON as `reckon`; what it prints goes to
FOLDER/page.log too. `--small` makes the replacements that the page itself lists, in a comment of lines

    <!-- small: count = 300 -> count = 40 -->

each of which must be found. Blocks of other kinds are for reading. Ends with the first command that fails, and
with 77 where a command says that reckon was built without what it needs.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SMALL = re.compile(r"^<!-- small: (.+?) -> (.+?) -->$", re.MULTILINE)
LEFT_OUT = ("built without", "component ct")


def blocks(text, small):
    """(kind, content) of every fenced block, with the page's replacements where asked for."""
    found = BLOCK.findall(text)
    if not small:
        return found
    for old, new in SMALL.findall(text):
        if not any(old in content for _, content in found):
            raise SystemExit(f"the page has no block with \"{old}\"")
        found = [(kind, content.replace(old, new)) for kind, content in found]
    return found


def follow(found, folder, reckon):
    path = folder / "bin"
    path.mkdir(parents=True)
    (path / "reckon").symlink_to(reckon.resolve())
    environment = {**os.environ, "PATH": f"{path}:{os.environ['PATH']}"}
    commands = 0
    with (folder / "page.log").open("w", encoding="utf-8") as log:
        for kind, content in found:
            if kind == "toml":
                name = re.match(r"# (\S+\.toml)\b", content)
                if name:
                    (folder / name.group(1)).write_text(content, encoding="utf-8")
            if kind != "sh":
                continue
            commands += 1
            print("$", content.rstrip().replace("\n", "\n$ "), file=log, flush=True)
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", content], cwd=folder, env=environment, check=False,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            print(done.stdout, file=log, flush=True)
            if done.returncode != 0:
                print(f"This failed with {done.returncode}:\n{content}\n{done.stdout}")
                skipped = any(part in done.stdout for part in LEFT_OUT)
                return 77 if skipped else 1
    print(f"{commands} blocks of commands ran")
    return 0 if commands else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("reckon", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--small", action="store_true")
    options = parser.parse_args()
    if options.folder.exists() and any(options.folder.iterdir()):
        raise SystemExit(f"{options.folder} is not empty")
    found = blocks(options.page.read_text(encoding="utf-8"), options.small)
    return follow(found, options.folder, options.reckon)


if __name__ == "__main__":
    sys.exit(main())
