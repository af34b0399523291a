#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks what no compiler checks: the module order and the conventions of the sources.

Each rule is a function from a Project to complaints "file:line: text". Run without arguments to
apply all of them to the repository; exits 1 when any rule complains.
"""
import dataclasses
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

SPDX_LINES = (
    "SPDX-FileCopyrightText: Sand Reckoner contributors",
    "SPDX-License-Identifier: BSD-3-Clause",
)
CPP_SUFFIXES = (".cpp", ".hpp")
COMMENTED_SUFFIXES = CPP_SUFFIXES + (".py", ".sh", ".cmake")
LONGEST_FILE = 500  # lines; nine in ten should stay under 250
MPI_MODULES = ("parallel", "domain")


@dataclasses.dataclass
class Project:
    """Tracked text files by their path from the root, and the order of the modules."""

    files: dict[str, str]
    modules: list[str]

    def sources(self, prefix=""):
        """C++ files below `prefix`, in order of their names."""
        for path in sorted(self.files):
            if path.startswith(prefix) and path.endswith(CPP_SUFFIXES):
                yield path, self.files[path]


def module_order(cmake_text):
    """Modules in the order in which src/reckon/CMakeLists.txt adds them."""
    return re.findall(r"^\s*add_subdirectory\((\w+)\)", cmake_text, re.MULTILINE)


def read_project(root=ROOT):
    """All files that git tracks, or would track, below `root`."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=root, check=True, capture_output=True, text=True).stdout
    files = {}
    for name in filter(None, listed.split("\0")):
        path = root / name
        if not path.is_file() or path.is_symlink():
            continue
        try:
            files[name] = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue  # a picture or other binary
    return Project(files, module_order(files["src/reckon/CMakeLists.txt"]))


def without_comments(text):
    """`text` with C++ comments blanked and string contents emptied; lines keep their numbers."""
    pattern = r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"'

    def blank(match):
        lines = "\n" * match.group().count("\n")
        return lines if match.group().startswith("/") else '""' + lines

    return re.sub(pattern, blank, text, flags=re.DOTALL)


def matches(text, pattern):
    """(line number, match) of each match of `pattern`."""
    for number, line in enumerate(text.splitlines(), start=1):
        for match in re.finditer(pattern, line):
            yield number, match


def reckon_includes(text):
    return matches(text, r'^\s*#\s*include\s+"reckon/((\w+)/[^"]+)"')


def module_of(path):
    parts = path.split("/")
    return parts[2] if path.startswith("src/reckon/") and len(parts) > 3 else None


def includes_follow_module_order(project):
    """A module includes itself and those that src/reckon/CMakeLists.txt adds before it."""
    rank = {name: place for place, name in enumerate(project.modules)}
    for path, text in project.sources("src/reckon/"):
        module = module_of(path)
        if module not in rank:
            yield f"{path}:1: its folder is no module of src/reckon/CMakeLists.txt"
            continue
        for number, match in reckon_includes(text):
            used = match.group(2)
            if used not in rank:
                yield f"{path}:{number}: includes '{used}', which is no module"
            elif rank[used] > rank[module]:
                yield f"{path}:{number}: '{module}' comes before '{used}' and may not include it"


def targets_follow_module_order(project):
    """CMake links in the same order, so the link graph is the include graph."""
    rank = {name: place for place, name in enumerate(project.modules)}
    for module in project.modules:
        path = f"src/reckon/{module}/CMakeLists.txt"
        for number, match in matches(project.files.get(path, ""), r"reckon::(\w+)"):
            if rank.get(match.group(1), len(rank)) >= rank[module]:
                yield f"{path}:{number}: '{module}' may not link reckon::{match.group(1)}"


def includes_have_no_cycle(project):
    """No header reaches itself again through the headers that it includes."""
    graph = {}
    for path, text in project.sources("src/reckon/"):
        graph[path[len("src/reckon/"):]] = [m.group(1) for _, m in reckon_includes(text)]
    done, trail = set(), []

    def walk(header):
        if header in trail:
            yield " -> ".join(trail[trail.index(header):] + [header])
        elif header not in done:
            trail.append(header)
            for used in graph.get(header, []):
                yield from walk(used)
            trail.pop()
            done.add(header)

    for header in sorted(graph):
        for cycle in walk(header):
            yield f"src/reckon/{header}:1: include cycle {cycle}"


def includes_name_full_paths(project):
    """Quoted includes are the project's own, by full path; src/ uses no ../ and no local names."""
    for path, text in project.sources("src/"):
        for number, match in matches(text, r'^\s*#\s*include\s+"([^"]+)"'):
            if not match.group(1).startswith("reckon/"):
                yield f"{path}:{number}: write the full path, \"reckon/...\", not \"{match.group(1)}\""


def own_header_comes_first(project):
    """A source includes its own header first, which proves that the header compiles alone."""
    for path, text in project.sources("src/reckon/"):
        header = path[:-len(".cpp")] + ".hpp"
        if not path.endswith(".cpp") or header not in project.files:
            continue
        first = re.search(r'^\s*#\s*include\s+(\S+)', text, re.MULTILINE)
        wanted = f'"{header[len("src/"):]}"'
        if first is None or first.group(1) != wanted:
            yield f"{path}:1: include {wanted} first"


def headers_guard_themselves(project):
    """Every header has #pragma once."""
    for path, text in project.sources():
        if path.endswith(".hpp") and "#pragma once" not in text.split("#include")[0]:
            yield f"{path}:1: '#pragma once' is missing"


def libraries_stay_silent(project):
    """Code under src/ neither prints nor ends the program: it returns or throws."""
    prints = r"\bstd::(?:cout|cerr|clog)\b|\bfmt::print\b|(?<!\w)(?:std::)?(?:f?printf|f?puts|putchar)\s*\("
    ends = r"(?<!\w)(?:std::)?(?:abort|exit|_exit|_Exit|quick_exit|terminate)\s*\("
    for path, text in project.sources("src/"):
        # Only the communicator may end a process: all ranks together, when one of them cannot
        # continue.
        communicator = path.startswith("src/reckon/parallel/communicator")
        for number, match in matches(without_comments(text), prints if communicator else f"{prints}|{ends}"):
            yield f"{path}:{number}: a library may not use '{match.group().rstrip('( ')}'"


def mpi_stays_in_its_modules(project):
    """MPI is called only in parallel/ and domain/."""
    for path, text in project.sources("src/"):
        if module_of(path) in MPI_MODULES:
            continue
        for number, match in matches(without_comments(text), r"\bMPI_\w+|<mpi\.h>"):
            yield f"{path}:{number}: '{match.group()}' belongs in {', '.join(MPI_MODULES)}"


def random_numbers_are_counter_based(project):
    """The standard library's distributions differ between implementations; its engines have state."""
    for path, text in project.sources("src/"):
        for number, match in matches(without_comments(text), r"#\s*include\s+<random>|\bs?rand\s*\("):
            yield f"{path}:{number}: use reckon/core/random.hpp, not '{match.group()}'"


def files_name_their_licence(project):
    """Two SPDX lines open every source and script."""
    for path, text in sorted(project.files.items()):
        name = path.rsplit("/", 1)[-1]
        wanted = (path.endswith(COMMENTED_SUFFIXES) or name == "CMakeLists.txt"
                  or text.startswith("#!"))
        if wanted and not all(line in "\n".join(text.splitlines()[:4]) for line in SPDX_LINES):
            yield f"{path}:1: the two SPDX lines are missing"


def texts_stand_alone(project):
    """No path of one machine, no package host, no note to self, no numbered issue."""
    patterns = {
        r"(?<![\w.~}])/(?:work|root|home)/": "a path of one machine",
        r"\b(?:deb\.debian\.org|registry\.npmjs\.org|pypi\.org)\b": "the name of a package host",
        r"\b(?:TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b": "a note to self",
        r"(?i)\b(?:issue|pr|pull request) ?#\d+": "the number of an issue",
    }
    for path, text in sorted(project.files.items()):
        for pattern, what in patterns.items():
            for number, match in matches(text, pattern):
                yield f"{path}:{number}: '{match.group()}' is {what}"


def files_stay_short(project):
    """A source over LONGEST_FILE lines needs a reason, or must be split."""
    for path, text in sorted(project.files.items()):
        length = text.count("\n")
        if path.endswith(CPP_SUFFIXES + (".py", ".ts")) and length > LONGEST_FILE:
            yield f"{path}:1: {length} lines, over {LONGEST_FILE}: has it a reason not to be split?"


def dependencies_are_explained(project):
    """docs/dependencies.md has every package that tools/install_dependencies.sh installs."""
    listed = subprocess.run(
        ["bash", "-s", "--", "--list", "build", "test", "viewer"],
        input=project.files["tools/install_dependencies.sh"],
        check=True, capture_output=True, text=True).stdout.split()
    page = "docs/dependencies.md"
    for package in listed:
        if f"`{package}`" not in project.files.get(page, ""):
            yield f"{page}:1: does not say why `{package}` is installed"


RULES = (
    includes_follow_module_order,
    targets_follow_module_order,
    includes_have_no_cycle,
    includes_name_full_paths,
    own_header_comes_first,
    headers_guard_themselves,
    libraries_stay_silent,
    mpi_stays_in_its_modules,
    random_numbers_are_counter_based,
    files_name_their_licence,
    texts_stand_alone,
    dependencies_are_explained,
)
ADVICE = (files_stay_short,)  # printed, but no fault


def main():
    project = read_project()
    complaints = 0
    for rule in RULES:
        for complaint in rule(project):
            print(f"{complaint}  [{rule.__name__}]")
            complaints += 1
    for rule in ADVICE:
        for complaint in rule(project):
            print(f"note: {complaint}")
    print(f"{len(RULES)} rules over {len(project.files)} files: {complaints} complaints")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
