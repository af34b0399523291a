#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Follows a page of the manual word for word, as tools/doc_commands.py describes.

  run_page.py PAGE RECKON FOLDER [--small] [--python PACKAGES]

FOLDER becomes what a reader has after ./quickstart: a checkout of the project (its examples, tools and documents)
with the program where the release preset builds it; the home folder is in it too, and `reckon` is on the path. In
the order of the page, a block ```toml whose first line is a comment with a file name (# settle.toml) is written to
that file, and each block of commands is run by one bash, which ends at the first command that fails. `--small` makes
the replacements that the page lists. Ends with 77 where a command says that reckon was built without what it needs.
"""
import argparse
import os
import pathlib
import re
import shlex
import shutil
import stat
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import doc_commands  # noqa: E402  pylint: disable=wrong-import-position

LEFT_OUT = ("built without", "component ct")
COPIED = ("README.md", "examples", "tools", "bench", "docs", "tests/install")
# Stands for the program in small runs.
SMALL_PROGRAM = """#!/usr/bin/env bash
arguments=("$@")
case "${{1:-}}" in
  run) [[ " $* " == *" --steps "* || {steps} == 0 ]] || arguments+=(--steps {steps}) ;;
  grains)
    for n in "${{!arguments[@]}}"; do
      [[ ${{2:-}} != generate || {shapes} == 0 || ${{arguments[n]}} != --count ]] || arguments[n+1]={shapes}
    done ;;
esac
exec {program} "${{arguments[@]}}"
"""


def lay_out(folder, reckon, limits, python):
    """The checkout and the home of the reader."""
    checkout = folder / "sand-reckoner"
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", *COPIED],
                            cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (checkout / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, checkout / name)
    programs = checkout / "build/release/apps/reckon"
    programs.mkdir(parents=True)
    (folder / "home").mkdir()
    program = programs / "reckon"
    if limits:
        program.write_text(SMALL_PROGRAM.format(steps=limits.get("steps", 0), shapes=limits.get("shapes", 0),
                                                program=shlex.quote(str(reckon.resolve()))), encoding="utf-8")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
    else:
        program.symlink_to(reckon.resolve())
    if python:
        (checkout / "build/release/python").symlink_to(python.resolve())
    return checkout


def heredoc(command, text):
    return f"{command} <<'END_OF_BLOCK'\n{text}END_OF_BLOCK\n"


def script_of(page, small):
    """One bash script of all that is run, and the number of its blocks."""
    def changed(text):
        for old, new in page.replacements if small else ():
            text = text.replace(old, new)
        return text

    for old, _ in page.replacements if small else ():
        if not any(old in block.text for block in page.blocks):
            raise SystemExit(f"the page has no block with \"{old}\"")
    script, count, python_done = "", 0, False
    for block in page.blocks:
        text = changed(block.text)
        name = re.match(r"# (\S+\.toml)\b", text)
        if block.kind == "toml" and name:
            script += heredoc(f"cat > {name.group(1)}", text)
        elif block.kind == "python" and not block.skipped and not python_done:
            python_done = True
            whole = "".join(changed(other.text) for other in page.blocks if other.kind == "python" and not other.skipped)
            script += heredoc("/usr/bin/python3 -", whole)
            count += 1
        elif block.kind == "first" or (block.kind == "sh" and not block.skipped):
            script += heredoc("sed 's/^/$ /'", text) + text
            count += block.kind == "sh"
    return script, count


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("reckon", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--python", type=pathlib.Path, help="where the package `reckon` lies")
    options = parser.parse_args()
    if options.folder.exists() and any(options.folder.iterdir()):
        raise SystemExit(f"{options.folder} is not empty")
    page = doc_commands.parse(options.page.read_text(encoding="utf-8"))
    script, count = script_of(page, options.small)
    if not options.python and any(block.kind == "python" and not block.skipped for block in page.blocks):
        print("skipped: built without the Python package")
        return 77
    checkout = lay_out(options.folder.absolute(), options.reckon, page.limits if options.small else {}, options.python)
    packages = f"{checkout}/build/release/python"
    if options.small and page.limits.get("plots") == 0:
        (options.folder / "no_plots").mkdir()
        (options.folder / "no_plots/matplotlib.py").write_text("raise ImportError\n", encoding="utf-8")
        packages = f"{options.folder.absolute()}/no_plots:{packages}"
    environment = {**os.environ, "HOME": str(options.folder.absolute() / "home"),
                   "PATH": f"{checkout}/build/release/apps/reckon:{os.environ['PATH']}",
                   "PYTHONPATH": packages, "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=checkout, env=environment, check=False,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    (options.folder / "page.log").write_text(done.stdout, encoding="utf-8")
    if done.returncode != 0:
        print(f"{options.page}: failed with {done.returncode}; its output:\n{done.stdout[-6000:]}")
        skipped = any(part in done.stdout for part in LEFT_OUT)
        return 77 if skipped else 1
    print(f"{count} blocks of commands ran")
    return 0 if count else 1


if __name__ == "__main__":
    sys.exit(main())
