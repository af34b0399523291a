#!/usr/bin/python3
# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs every check of the project, one stage after the other, whatever fails before.

The last line counts what was shown: each test of a test suite, and each other stage as one.
Logs and test reports stay in build/check/.
"""
import argparse
import dataclasses
import os
import pathlib
import re
import shlex
import subprocess
import sys
import textwrap
import time
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent
LOGS = ROOT / "build" / "check"
JOBS = os.cpu_count() or 1
SHOWN_LINES = 60  # of a failed stage's log


@dataclasses.dataclass
class Outcome:
    """The result of a stage."""

    passed: int
    failed: int
    skipped: int = 0
    details: str = ""  # what the output should show


def run(log, *commands, environment=None):
    """A stage made of commands: it passes when all of them do, and ends with the first that fails."""
    environment = {**os.environ, **(environment or {})}
    code = 0
    with log.open("w", encoding="utf-8", errors="replace") as out:
        for command in commands:
            print("$", textwrap.shorten(shlex.join(command), 200), file=out, flush=True)
            try:
                code = subprocess.run(command, cwd=ROOT, env=environment, stdout=out, check=False,
                                      stdin=subprocess.DEVNULL, stderr=subprocess.STDOUT).returncode
            except OSError as error:
                print(error, file=out)
                code = 127
            if code != 0:
                break
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    if code != 0:
        return Outcome(passed=0, failed=1, details="\n".join(lines[-SHOWN_LINES:]))
    notes = [line for line in lines if line.startswith("note: ")]
    return Outcome(passed=1, failed=0, details="\n".join(notes))


def tool(*arguments):
    """A stage that runs one of the project's own Python tools."""
    return lambda log: run(log, [sys.executable, "-B", *arguments])


def tool_tests(log):
    """The tests of the tools themselves."""
    outcome = tool("-m", "unittest", "discover", "-v", "-s", "tests/tools")(log)
    verdicts = re.findall(r" \.\.\. (ok|FAIL|ERROR)$", log.read_text(encoding="utf-8"), re.MULTILINE)
    outcome.passed = verdicts.count("ok")
    outcome.failed = max(len(verdicts) - outcome.passed, outcome.failed)
    return outcome


def tracked(*patterns):
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "--",
                             *patterns], cwd=ROOT, check=True, capture_output=True, text=True)
    return [name for name in listed.stdout.splitlines() if (ROOT / name).is_file()]


def formatting(log):
    return run(log, ["clang-format", "--dry-run", "--Werror", "--ferror-limit=1",
                     *tracked("*.cpp", "*.hpp")])


def scripts(log):
    return run(log, *(["bash", "-n", script]
                      for script in ["check", "quickstart", ".ci/run", *tracked("*.sh")]))


def lone_headers(log):
    """Headers without a source compile alone; the others are the first include of their source."""
    toolkit = [f"-isystem{folder}" for folder in pathlib.Path("/usr/include").glob("ITK-*")]
    compiler = ["mpicxx", "-std=c++20", "-fopenmp", "-Isrc", *toolkit, "-fsyntax-only", "-x", "c++",
                "/dev/null", "-include"]
    return run(log, *([*compiler, header] for header in tracked("src/*.hpp")
                      if not (ROOT / header).with_suffix(".cpp").exists()))


def build(preset, *targets):
    """A stage that configures and builds one preset."""
    make = ["cmake", "--build", "--preset", preset, "-j", str(JOBS)]
    if targets:
        make += ["--target", *targets]
    # Warnings are errors here, independent of the preset; -k 0 continues with other files.
    return lambda log: run(log, ["cmake", "--preset", preset, "-DRECKON_WARNINGS_AS_ERRORS=ON"],
                           [*make, "--", "--quiet", "-k", "0"])


def tests(preset, *selection, environment=None):
    """A stage that runs the tests of a built preset; `selection` is passed to ctest."""
    def stage(log):
        report = log.with_suffix(".xml")
        report.unlink(missing_ok=True)
        outcome = run(log, ["ctest", "--preset", preset, "-j", str(JOBS), "--no-tests=error",
                            "--output-junit", str(report), *selection], environment=environment)
        if report.exists():
            count_tests(report, outcome)
        return outcome
    return stage


def count_tests(report, outcome):
    """Replaces the single result of the command by the counts and failures of a JUnit report."""
    outcome.passed = outcome.skipped = failed = 0
    details = []
    for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase"):
        skipped = case.find("skipped")
        if case.get("status") == "run":
            outcome.passed += 1
        elif skipped is not None and skipped.get("message", "").startswith("SKIP_"):
            outcome.skipped += 1  # it prints it itself
        else:  # failed, or could not be started
            failed += 1
            output = (case.findtext("system-out") or "").strip().splitlines()
            details += [f"--- {case.get('name')}", *output[-SHOWN_LINES // 2:]]
    outcome.failed = max(failed, outcome.failed)
    outcome.details = "\n".join(details) or outcome.details


def stages(mode):
    """(name, stage) in the order in which they run. Cheap ones first."""
    unhurried = ["-LE", "long"] if mode == "full" else []
    chosen = [
        ("source rules", tool("tools/source_rules.py")),
        ("links in the documents", tool("tools/doc_links.py")),
        ("commands in the documents", tool("tools/doc_commands.py")),
        ("tests of the tools", tool_tests),
        ("format", formatting),
        ("shell scripts", scripts),
        ("headers stand alone", lone_headers),
        ("build (g++)", build("dev")),
    ]
    if mode == "fast":
        return chosen + [("tests", tests("dev", "-LE", "slow|long|fuzz"))]
    thorough = {"RECKON_FUZZ_CASES": "200000"} if mode == "long" else {}
    return chosen + [
        ("tests", tests("dev", *unhurried)),
        ("build (clang, address and undefined-behaviour sanitizers)", build("asan-ubsan")),
        ("tests under these sanitizers", tests("asan-ubsan", "-LE", "slow|long", environment=thorough)),
        ("build (clang, thread sanitizer)", build("tsan", "threaded_tests")),
        ("threaded tests under it", tests("tsan", "-L", "threads", "-LE", "slow|long")),
        ("clang-tidy", tool("tools/clang_tidy.py", "build/asan-ubsan")),
    ]


def prepare_environment():
    """ccache across clones, quiet waiting threads, reproducible tool output."""
    LOGS.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("CMAKE_CXX_COMPILER_LAUNCHER", "ccache")
    os.environ.setdefault("CCACHE_BASEDIR", str(ROOT))
    os.environ.setdefault("CCACHE_NOHASHDIR", "true")
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # tests run side by side


def duration(seconds):
    return f"{seconds:.1f} s" if seconds < 60 else f"{seconds // 60:.0f} min {seconds % 60:.0f} s"


def main():
    parser = argparse.ArgumentParser(prog="./check", description="Runs the checks of the project.")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--fast", action="store_const", const="fast", dest="mode", default="full",
                       help="rules, one build and its quick tests")
    which.add_argument("--long", action="store_const", const="long", dest="mode",
                       help="also tests that take many minutes, and more fuzzing")
    mode = parser.parse_args().mode

    prepare_environment()
    started = time.monotonic()
    summary = []
    for number, (name, stage) in enumerate(stages(mode), start=1):
        print(f"== {name}", flush=True)
        begin = time.monotonic()
        outcome = stage(LOGS / f"{number:02}.log")
        took = duration(time.monotonic() - begin)
        verdict = "FAILED" if outcome.failed else "passed"
        counts = f"{outcome.passed} passed, {outcome.failed} failed"
        if outcome.skipped:
            counts += f", {outcome.skipped} skipped"
        if outcome.details:
            print(outcome.details)
        if outcome.failed:
            print(f"   (whole log: build/check/{number:02}.log)")
        print(f"   {verdict} in {took}" + (f": {counts}" if outcome.passed + outcome.failed > 1 else ""),
              flush=True)
        summary.append((name, verdict, took, outcome))

    print(f"\n== summary, {duration(time.monotonic() - started)} in all")
    for name, verdict, took, outcome in summary:
        print(f"   {verdict}  {took:>12}  {outcome.passed:5} passed {outcome.failed:3} failed "
              f"{outcome.skipped:3} skipped   {name}")
    passed, failed, skipped = (sum(getattr(outcome, field) for *_, outcome in summary)
                               for field in ("passed", "failed", "skipped"))
    print(f"\n{passed} passed, {failed} failed, {skipped} skipped")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
