#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The commands in the Markdown pages: as a reader types them, in the order of each page.

A block ```sh is run by the tests (tests/documents), all blocks of a page in one shell; so is a page's Python, the
blocks ```python of a page being one program. Comments in the source of a page hold what readers do not need:

    <!-- not run: REASON -->             before a block: the tests leave it out
    <!-- small: OLD -> NEW -->           in the tests, NEW stands for OLD in all blocks of the page
    <!-- small: steps N, shapes M -->    in the tests, `reckon run` makes N steps, and `generate` M shapes; with
                                         "plots 0" scripts find no matplotlib, as so few steps make no curve
    <!-- first:                          commands that the tests run at this place
    COMMANDS
    -->

`--pages` lists the pages that have commands to run. Run as a program without it, it checks that no command escapes the tests:
commands stand in blocks ```sh, blocks that are not run have a reason, and every `reckon COMMAND --option` in a page is one that
docs/reference/commands.md lists.
"""
import dataclasses
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARTS = re.compile(r"^```(\w*)\n(.*?)^```$|<!--(.*?)-->", re.MULTILINE | re.DOTALL)
COMMAND = re.compile(
    r"(\$ )?([A-Z_]+=\S* )*(reckon |mpirun |srun |ssh |cmake |ctest|cpack |apt(-get)? |git |cd |mkdir |cp |export |sed |spack "
    r"|source |python3? |pvpython |paraview |/usr/bin/|\./[a-z]|(tools|examples|bench|build)/\S)")
MADE = "docs/reference/commands.md"  # made from the command line itself: its blocks show usage


@dataclasses.dataclass
class Block:
    """A fenced block, or commands for the tests alone."""
    kind: str  # sh, toml, python, first, ...
    text: str
    line: int
    skipped: str = ""  # why the tests leave it out


@dataclasses.dataclass
class Page:
    blocks: list
    replacements: list  # (old, new)
    limits: dict  # steps, shapes, plots
    complaints: list  # (line, text)


def parse(text):
    page = Page([], [], {}, [])
    reason, reason_line, reason_end = None, 0, 0
    for part in PARTS.finditer(text):
        line = text.count("\n", 0, part.start()) + 1
        kind, content, comment = part.groups()
        if comment is None:
            block = Block(kind, content, line)
            if reason is not None and not text[reason_end:part.start()].strip():
                block.skipped, reason = reason, None
            page.blocks.append(block)
            continue
        if reason is not None:
            page.complaints.append((reason_line, "\"not run\" does not stand before a block"))
            reason = None
        word, colon, rest = comment.strip().partition(":")
        if colon and word == "not run":
            reason, reason_line, reason_end = " ".join(rest.split()), line, part.end()
            if len(reason) < 10:
                page.complaints.append((line, "\"not run\" needs a reason"))
        elif colon and word == "small" and " -> " in rest:
            old, new = rest.strip().split(" -> ", 1)
            page.replacements.append((old, new))
        elif colon and word == "small":
            page.limits.update((name, int(number)) for name, number in re.findall(r"(\w+) (\d+)", rest))
        elif colon and word == "first":
            page.blocks.append(Block("first", rest.strip("\n") + "\n", line))
    if reason is not None:
        page.complaints.append((reason_line, "\"not run\" does not stand before a block"))
    return page


def is_run(block):
    return block.kind in ("sh", "python") and not block.skipped


def outside_of_blocks(text):
    """`text` with fenced blocks and comments blanked; lines keep their numbers."""
    return PARTS.sub(lambda part: "\n" * part.group().count("\n"), text)


def known_options(reference):
    """{command: options} of docs/reference/commands.md."""
    known = {"reckon": {"--help", "-h", "--version"}}
    for section in re.split(r"^## ", reference, flags=re.MULTILINE)[1:]:
        name = section.partition("\n")[0].strip()
        known[name] = {"--help", "-h"}
        for row in re.findall(r"^\| `([^`]*)`", section, re.MULTILINE):
            known[name] |= set(re.findall(r"(?<!\w)--?[a-zA-Z][\w-]*", row))
    return known


def unknown_names(command_line, known):
    """The commands and options in a line that reckon does not have."""
    command_line = re.sub(r"(^|\s)#.*", "", command_line)
    for call in re.findall(r"(?:(?:^|[|;&(]\s*)\S*/|^|\s)reckon ((?:[^|;&`>()\n]|\\\n)*)", command_line, re.MULTILINE):
        words = call.replace("\\\n", " ").split()
        name = "reckon"
        while words and f"{name} {words[0]}" in known:
            name += " " + words.pop(0)
        if name == "reckon" and words and re.fullmatch(r"[a-z]+", words[0]):
            yield f"there is no command `reckon {words[0]}`"
            continue
        if any(other.startswith(name + " ") for other in known):
            continue  # "reckon grains ...": any of its commands
        for word in words:
            option = word.partition("=")[0]
            if re.fullmatch(r"--?[a-zA-Z][\w-]*", option) and name != "reckon" and option not in known[name]:
                yield f"`{name}` has no option {option}"


def complaints_of(text, known, made=False):
    """(line, complaint) about the commands of one page."""
    page = parse(text)
    yield from page.complaints
    for block in page.blocks:
        lines = block.text.splitlines()
        commands = [line for line in lines if COMMAND.match(line)]
        if commands and block.kind not in ("sh", "first", "python") and not made:
            yield block.line, f"a command outside of a block ```sh: {commands[0]}"
        if block.kind in ("sh", "first", ""):
            for complaint in unknown_names(block.text, known):
                yield block.line, complaint
    for number, line in enumerate(outside_of_blocks(text).splitlines(), start=1):
        if line.startswith("    ") and COMMAND.match(line.strip()):
            yield number, f"a command outside of a block ```sh: {line.strip()}"
        for code in re.findall(r"`([^`]+)`", line):
            if code.startswith("reckon ") and "::" not in code:
                for complaint in unknown_names(code, known):
                    yield number, complaint


def tracked_pages():
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", "*.md"],
        cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [name for name in filter(None, listed.split("\0")) if (ROOT / name).is_file()]


def pages_to_run():
    """The pages that have a block to run."""
    for name in tracked_pages():
        if any(map(is_run, parse((ROOT / name).read_text(encoding="utf-8")).blocks)):
            yield name


def main():
    if sys.argv[1:] == ["--pages"]:
        print("\n".join(pages_to_run()))
        return 0
    known = known_options((ROOT / MADE).read_text(encoding="utf-8"))
    found = []
    blocks = []
    for name in tracked_pages():
        text = (ROOT / name).read_text(encoding="utf-8")
        found += [f"{name}:{line}: {complaint}" for line, complaint in complaints_of(text, known, name == MADE)]
        blocks += [block for block in parse(text).blocks if block.kind in ("sh", "python")]
    run = sum(map(is_run, blocks))
    print("\n".join(found + [f"{run} blocks of commands are run, {len(blocks) - run} say why not: {len(found)} faults"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
