#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws which module includes which, as the Mermaid diagram of ARCHITECTURE.md.

The arrows come from the #include lines of src/reckon. An arrow is left out where a longer way
says the same: if a includes b and b includes c, a may include c too. Without arguments the
diagram is printed; --write puts it into the page. A rule of source_rules.py compares the two.
"""
import argparse
import pathlib

import source_rules

PAGE = "ARCHITECTURE.md"
BEGIN = "<!-- begin of the diagram: tools/module_picture.py --write -->\n"
END = "<!-- end of the diagram -->\n"


def included_modules(project):
    """{module: the other modules that its files include}, in the order of the modules."""
    included = {name: set() for name in project.modules}
    for path, text in project.sources("src/reckon/"):
        module = source_rules.module_of(path)
        for _, match in source_rules.reckon_includes(text):
            if module in included and match.group(2) in included:
                included[module].add(match.group(2))
    return {name: used - {name} for name, used in included.items()}


def without_shortcuts(included):
    """The same without each module that another included module reaches."""
    reached = {}
    for name, used in included.items():  # those that come before are complete
        reached[name] = used.union(*(reached[other] for other in used))
    return {name: used - set().union(*(reached[other] for other in used))
            for name, used in included.items()}


def diagram(project):
    """The lines between the marks of the page."""
    lines = ["```mermaid", "flowchart TD"]
    for name, used in without_shortcuts(included_modules(project)).items():
        lines += [f"  {name} --> {other}" for other in project.modules if other in used]
    return "\n".join(lines + ["```", ""])


def page_with(project, drawn):
    """The text of the page with `drawn` between its marks."""
    before, _, rest = project.files[PAGE].partition(BEGIN)
    _, mark, after = rest.partition(END)
    if not mark:
        raise ValueError(f"{PAGE} lacks the marks of the diagram")
    return before + BEGIN + drawn + END + after


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--write", action="store_true", help=f"put the diagram into {PAGE}")
    options = parser.parse_args()
    project = source_rules.read_project()
    if options.write:
        page = source_rules.ROOT / pathlib.Path(PAGE)
        page.write_text(page_with(project, diagram(project)), encoding="utf-8")
    else:
        print(diagram(project), end="")


if __name__ == "__main__":
    main()
