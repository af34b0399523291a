# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Spack recipe, compared with the requirements of CMake. Spack itself is not needed."""
import contextlib
import pathlib
import re
import sys
import types
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
REPOSITORY = ROOT / "packaging/spack/spack_repo/reckon"
RECIPE = REPOSITORY / "packages/reckon/package.py"

# What CMake finds, and who brings it in Spack. None: comes with the compiler or CMake.
PACKAGE_OF = {"Threads": None, "OpenMP": None, "fmt": "fmt", "Eigen3": "eigen", "HDF5": "hdf5", "tomlplusplus": "tomlplusplus",
              "CLI11": "cli11", "hwy": "highway", "ZLIB": "zlib-api", "TIFF": "libtiff", "MPI": "mpi", "Zoltan": "zoltan", "ITK": "itk",
              "Python": "python", "pybind11": "py-pybind11", "GTest": "googletest"}
FOR_DEVELOPERS = {"RECKON_WARNINGS_AS_ERRORS", "RECKON_FUZZERS"}


class Recipe:
    """The recipe read with stand-ins for Spack's directives, which record their arguments."""

    def __init__(self):
        self.variants, self.dependencies, self.versions = {}, {}, {}
        scope = []  # of enclosing `with when(...)`

        def depends_on(spec, when=None, type=None):
            name = re.split(r"[@+~%]", spec)[0]
            self.dependencies.setdefault(name, " ".join([*scope, when or ""]).strip())

        @contextlib.contextmanager
        def when(condition):
            scope.append(condition)
            yield
            scope.pop()

        class CMakePackage:
            run_tests = False
            spec = types.SimpleNamespace(satisfies=lambda condition: True)

            @staticmethod
            def define(name, value):
                return (name, None)

            @staticmethod
            def define_from_variant(name, variant):
                return (name, variant)

        fake = types.ModuleType("spack.package")
        fake.__dict__.update(
            license=lambda name: None, conflicts=lambda spec: None,
            version=lambda name, **place: self.versions.update({name: place}),
            variant=lambda name, **facts: self.variants.update({name: facts}),
            depends_on=depends_on, extends=depends_on, when=when, python_platlib="lib",
            run_after=lambda phase, when: (lambda method: method),
            python=types.SimpleNamespace(path="python"))
        cmake = types.ModuleType("spack_repo.builtin.build_systems.cmake")
        cmake.CMakePackage = CMakePackage  # Spack's API 2 has it here and no longer in spack.package
        packages = ["spack", "spack_repo", "spack_repo.builtin", "spack_repo.builtin.build_systems"]
        modules = {name: types.ModuleType(name) for name in packages}
        with mock.patch.dict(sys.modules, {**modules, "spack.package": fake, cmake.__name__: cmake}):
            scope_of_recipe = {"__file__": str(RECIPE)}
            exec(compile(RECIPE.read_text(encoding="utf-8"), RECIPE, "exec"), scope_of_recipe)  # pylint: disable=exec-used
        self.package = scope_of_recipe["Reckon"]
        self.definitions = dict(self.package().cmake_args())


def cmake_texts():
    files = [ROOT / "CMakeLists.txt", *(ROOT / "src").rglob("CMakeLists.txt"), *(ROOT / "viewer").glob("CMakeLists.txt"),
             *(ROOT / "python").glob("CMakeLists.txt")]
    return "\n".join(file.read_text(encoding="utf-8") for file in files)


class SpackRecipe(unittest.TestCase):
    def setUp(self):
        self.recipe = Recipe()
        self.cmake = cmake_texts()

    def test_sets_every_option_of_the_build_and_no_other(self):
        options = set(re.findall(r"^(?:option|cmake_dependent_option)\((RECKON_\w+)", self.cmake, re.MULTILINE))
        self.assertIn("RECKON_MPI", options)
        caches = set(re.findall(r"\bset\((RECKON_\w+) .* CACHE ", self.cmake))
        given = set(self.recipe.definitions) - {"Python_EXECUTABLE"}
        self.assertEqual(options - given, FOR_DEVELOPERS)
        self.assertEqual(given - options - caches, set())

    def test_every_variant_decides_an_option(self):
        self.assertEqual({variant for variant in self.recipe.definitions.values() if variant}, set(self.recipe.variants))
        for name, facts in self.recipe.variants.items():
            self.assertTrue(facts["description"], name)

    def test_brings_every_package_that_is_looked_for(self):
        found = set(re.findall(r"^\s*find_package\((\w+)", self.cmake, re.MULTILINE))
        self.assertEqual(found - set(PACKAGE_OF), set(), "unknown to this test")
        self.assertEqual(set(PACKAGE_OF) - found, set(), "no longer looked for")
        wanted = {package for package in PACKAGE_OF.values() if package}
        self.assertEqual(wanted - set(self.recipe.dependencies), set())

    def test_optional_packages_come_with_their_variants(self):
        for package, condition in {"mpi": "+mpi", "zoltan": "+zoltan", "itk": "+ct", "npm": "+report",
                                   "py-pybind11": "+python"}.items():
            self.assertEqual(self.recipe.dependencies[package], condition)

    def test_asks_for_the_cmake_that_the_project_asks_for(self):
        least = re.search(r"cmake_minimum_required\(VERSION ([\d.]+)\)", self.cmake).group(1)
        self.assertIn(f'depends_on("cmake@{least}:"', RECIPE.read_text(encoding="utf-8"))

    def test_lies_where_the_package_api_looks_for_it(self):
        facts = (REPOSITORY / "repo.yaml").read_text(encoding="utf-8")
        self.assertIn("api: v2.0\n", facts)
        namespace = re.search(r"namespace: (\w+)\n", facts).group(1)
        self.assertEqual((REPOSITORY.name, REPOSITORY.parent.name), (namespace, "spack_repo"))
        self.assertEqual(RECIPE.parent.name.replace("_", "").lower(), self.recipe.package.__name__.lower())

    def test_builds_the_checkout_it_lies_in(self):
        self.assertEqual(self.recipe.package.git, ROOT.as_uri())


if __name__ == "__main__":
    unittest.main()
