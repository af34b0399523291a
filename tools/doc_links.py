#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that every relative link of the Markdown pages leads to a file, and to a heading or anchor
of it."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def without_code(text):
    """`text` with fenced and inline code blanked; lines keep their numbers."""
    text = re.sub(r"^```.*?^```", lambda m: "\n" * m.group().count("\n"), text,
                  flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "``", text)


def anchors(text):
    """The anchors of a page: those of its headings, and those that it names itself."""
    fenceless = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    found = set(re.findall(r'<a id="([^"]+)">', fenceless))
    for heading in re.findall(r"^#+ +(.*)$", fenceless, re.MULTILINE):
        plain = re.sub(r"[^\w\- ]", "", heading.strip().lower())
        found.add(plain.replace(" ", "-"))
    return found


def broken_links(page, root=ROOT):
    """Complaints "file:line: text" about the links of one page."""
    text = page.read_text(encoding="utf-8")
    for number, line in enumerate(without_code(text).splitlines(), start=1):
        for target in re.findall(r"\]\(<?([^)\s>]+)>?[^)]*\)", line):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            goal = (page.parent / path).resolve() if path else page.resolve()
            where = f"{page.relative_to(root)}:{number}"
            if not goal.is_relative_to(root):
                yield f"{where}: '{target}' leads out of the project"
            elif not goal.exists():
                yield f"{where}: '{target}' does not exist"
            elif anchor and goal.suffix == ".md":
                if anchor not in anchors(goal.read_text(encoding="utf-8")):
                    yield f"{where}: '{target}': that page has no such heading or anchor"


def main():
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", "*.md"],
        cwd=ROOT, check=True, capture_output=True, text=True).stdout
    pages = [ROOT / name for name in filter(None, listed.split("\0")) if (ROOT / name).is_file()]
    complaints = [text for page in pages for text in broken_links(page)]
    print("\n".join(complaints + [f"{len(pages)} pages: {len(complaints)} broken links"]))
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
