# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The diagram of the modules is that of the sources."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import module_picture  # noqa: E402
import source_rules  # noqa: E402


def project(**includes):
    """A project in which each module, in this order, has a file that includes these others."""
    files = {f"src/reckon/{name}/a.cpp": "".join(f'#include "reckon/{o}/a.hpp"\n' for o in others)
             for name, others in includes.items()}
    return source_rules.Project(files, list(includes))


class ModulePicture(unittest.TestCase):
    def test_shows_each_include_between_modules(self):
        drawn = module_picture.diagram(project(core=["core"], math=["core"], shape=["core"]))
        self.assertIn("  math --> core\n  shape --> core\n", drawn)
        self.assertNotIn("core -->", drawn)

    def test_leaves_out_what_a_longer_way_says(self):
        chain = project(core=[], math=["core"], shape=["math", "core"], scan=["core", "shape"])
        reduced = module_picture.without_shortcuts(module_picture.included_modules(chain))
        self.assertEqual(reduced, {"core": set(), "math": {"core"}, "shape": {"math"},
                                   "scan": {"shape"}})

    def test_the_page_has_the_diagram_of_the_sources(self):
        sources = source_rules.read_project()
        self.assertEqual(
            sources.files[module_picture.PAGE],
            module_picture.page_with(sources, module_picture.diagram(sources)),
            "run tools/module_picture.py --write")


if __name__ == "__main__":
    unittest.main()
