# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The statements of README, CONTRIBUTING and ARCHITECTURE about the build and the modules are true."""
import json
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import check  # noqa: E402  pylint: disable=wrong-import-position
import source_rules  # noqa: E402  pylint: disable=wrong-import-position

NUMBERS = {"twice": 2, "three times": 3, "four times": 4, "five times": 5}


def page(name):
    return " ".join((ROOT / name).read_text(encoding="utf-8").split())


class Statements(unittest.TestCase):
    def test_check_builds_as_often_as_the_readme_says(self):
        said = re.search(r"`\./check` builds (\w+(?: times)?)", page("README.md")).group(1)
        builds = [name for name, _ in check.stages("full") if name.startswith("build")]
        self.assertEqual(NUMBERS[said], len(builds))

    def test_long_files_are_a_note_for_check(self):
        self.assertNotIn("lines `./check` refuses", page("CONTRIBUTING.md"))
        self.assertIn(f"those over {source_rules.LONGEST_FILE} lines", page("CONTRIBUTING.md"))

    def test_mpi_is_called_where_the_architecture_says(self):
        said = re.search(r"its calls stay in ([^.]*)\.", page("ARCHITECTURE.md")).group(1)
        modules = re.findall(r"`(\w+)`", said)
        self.assertEqual(modules, list(source_rules.MPI_MODULES))
        for module in modules:
            sources = sorted((ROOT / "src/reckon" / module).glob("*.cpp"))
            self.assertTrue(any(re.search(r"MPI_|<mpi.h>", source.read_text(encoding="utf-8")) for source in sources), module)

    def test_modules_without_files_include_none(self):
        rows = re.findall(r"^\| `(\w+)` \| .* \| (.*) \|$", (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8"),
                          re.MULTILINE)
        without = [module for module, knows_not in rows if "files" in knows_not]
        for module in without:
            for source in sorted((ROOT / "src/reckon" / module).glob("*.?pp")):
                self.assertNotRegex(source.read_text(encoding="utf-8"), r"#include .*(_file\.hpp|fstream|hdf5)", source)
        self.assertGreater(len(rows), 10)

    def test_recipes_name_files_and_code_that_exist(self):
        text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
        recipes = text[text.index("\n## Recipes"):text.index("\n## Many processes")]
        self.assertEqual(len(re.findall(r"^### ", recipes, re.MULTILINE)), 5)
        for recipe in recipes.split("\n### ")[1:]:
            self.assertEqual(re.findall(r"^(\d)\. ", recipe, re.MULTILINE), ["1", "2", "3", "4"], recipe)
        spans = set(re.findall(r"`([^`]+)`", recipes))
        paths = {span for span in spans if "/" in span and " " not in span and "NAME" not in span}
        self.assertGreater(len(paths), 15)
        for path in paths:
            self.assertTrue((ROOT / path).exists(), path)
        sources = [file for folder in ("src", "tests") for file in sorted((ROOT / folder).rglob("*.?pp"))]
        code = "\n".join(file.read_text(encoding="utf-8") for file in sources)
        names = {span.removesuffix("()") for span in spans if re.fullmatch(r"[A-Za-z]\w+(\(\))?", span)}
        self.assertGreater(len(names), 10)
        for name in names:
            self.assertRegex(code, rf"\b{name}\b", name)

    def test_a_release_build_needs_no_googletest_and_quickstart_builds_what_pages_use(self):
        presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))
        release = next(preset for preset in presets["configurePresets"] if preset["name"] == "release")
        self.assertEqual(release["cacheVariables"]["RECKON_BUILD_TESTS"], "OFF")
        quickstart = (ROOT / "quickstart").read_text(encoding="utf-8")
        for group in ("build", "viewer", "ct", "python"):
            self.assertRegex(quickstart, rf"install_dependencies\.sh [\w ]*\b{group}\b")
        self.assertRegex(quickstart, r"--target reckon reckon_python\b")


if __name__ == "__main__":
    unittest.main()
