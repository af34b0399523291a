# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Each source rule accepts good files and finds the fault in a bad one."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import source_rules  # noqa: E402  (the path above comes first)

SPDX = "".join(f"// {line}\n" for line in source_rules.SPDX_LINES)
MODULES = ["core", "math", "parallel", "shape"]


def complaints(rule, **files):
    """The complaints of `rule` about files given as folder__name_suffix="text"."""
    named = {key.replace("__", "/").replace("_hpp", ".hpp").replace("_cpp", ".cpp")
             .replace("_txt", ".txt").replace("_md", ".md"): text for key, text in files.items()}
    return list(rule(source_rules.Project(named, MODULES)))


class SourceRules(unittest.TestCase):
    def test_module_order_is_read_from_cmake(self):
        self.assertEqual(
            source_rules.module_order("# add_subdirectory(no)\nadd_subdirectory(core)\n"
                                      "add_subdirectory(math)\n"), ["core", "math"])

    def test_includes_follow_module_order(self):
        rule = source_rules.includes_follow_module_order
        good = '#include "reckon/core/error.hpp"\n#include "reckon/math/vec3.hpp"\n'
        self.assertEqual(complaints(rule, src__reckon__math__a_hpp=good), [])
        upward = '#include "reckon/shape/shape.hpp"\n'
        self.assertEqual(len(complaints(rule, src__reckon__math__a_hpp=upward)), 1)
        unknown = '#include "reckon/elsewhere/shape.hpp"\n'
        self.assertEqual(len(complaints(rule, src__reckon__math__a_hpp=unknown)), 1)
        self.assertEqual(len(complaints(rule, src__reckon__elsewhere__a_hpp="")), 1)

    def test_targets_follow_module_order(self):
        rule = source_rules.targets_follow_module_order
        path = "src__reckon__math__CMakeLists_txt"
        self.assertEqual(complaints(rule, **{path: "reckon_module(math DEPENDS reckon::core)"}), [])
        self.assertEqual(len(complaints(rule, **{path: "reckon_module(math DEPENDS reckon::shape)"})), 1)
        self.assertEqual(len(complaints(rule, **{path: "reckon_module(math DEPENDS reckon::math)"})), 1)

    def test_includes_have_no_cycle(self):
        rule = source_rules.includes_have_no_cycle
        to_a, to_b = '#include "reckon/core/a.hpp"\n', '#include "reckon/core/b.hpp"\n'
        self.assertEqual(complaints(rule, src__reckon__core__a_hpp=to_b, src__reckon__core__b_hpp=""), [])
        found = complaints(rule, src__reckon__core__a_hpp=to_b, src__reckon__core__b_hpp=to_a)
        self.assertEqual(len(found), 1)
        self.assertIn("core/a.hpp -> core/b.hpp -> core/a.hpp", found[0])

    def test_includes_name_full_paths(self):
        rule = source_rules.includes_name_full_paths
        self.assertEqual(complaints(rule, src__reckon__core__a_cpp="#include <vector>\n"), [])
        self.assertEqual(len(complaints(rule, src__reckon__core__a_cpp='#include "a.hpp"\n')), 1)

    def test_own_header_comes_first(self):
        rule = source_rules.own_header_comes_first
        own, other = '#include "reckon/core/a.hpp"\n', "#include <vector>\n"
        self.assertEqual(complaints(rule, src__reckon__core__a_hpp="",
                                    src__reckon__core__a_cpp=own + other), [])
        self.assertEqual(len(complaints(rule, src__reckon__core__a_hpp="",
                                        src__reckon__core__a_cpp=other + own)), 1)

    def test_headers_guard_themselves(self):
        rule = source_rules.headers_guard_themselves
        self.assertEqual(complaints(rule, tests__a_hpp="#pragma once\n#include <vector>\n"), [])
        self.assertEqual(len(complaints(rule, tests__a_hpp="#include <vector>\n")), 1)

    def test_libraries_stay_silent(self):
        rule = source_rules.libraries_stay_silent
        quiet = '// std::cout\nconst char* text = "printf(";\nstd::snprintf(b, n, "x");\nloop.exit_now();\n'
        self.assertEqual(complaints(rule, src__reckon__core__a_cpp=quiet), [])
        for loud in ("std::cerr << 1;", 'printf("x");', 'fmt::print("x");', "std::exit(1);", "abort();"):
            self.assertEqual(len(complaints(rule, src__reckon__core__a_cpp=loud)), 1, loud)
        self.assertEqual(complaints(rule, apps__reckon__main_cpp="std::cout << 1;"), [])
        self.assertEqual(complaints(rule, src__reckon__parallel__communicator_cpp="std::_Exit(1);"), [])
        self.assertEqual(len(complaints(rule, src__reckon__parallel__threads_cpp="std::_Exit(1);")), 1)

    def test_mpi_stays_in_its_modules(self):
        rule = source_rules.mpi_stays_in_its_modules
        call = "MPI_Barrier(communicator);\n"
        self.assertEqual(complaints(rule, src__reckon__parallel__a_cpp=call), [])
        self.assertEqual(complaints(rule, src__reckon__core__a_cpp="// MPI_Barrier\n"), [])
        self.assertEqual(len(complaints(rule, src__reckon__core__a_cpp=call)), 1)

    def test_random_numbers_are_counter_based(self):
        rule = source_rules.random_numbers_are_counter_based
        self.assertEqual(complaints(rule, tests__a_cpp="#include <random>\n"), [])
        self.assertEqual(len(complaints(rule, src__reckon__core__a_cpp="#include <random>\n")), 1)
        self.assertEqual(len(complaints(rule, src__reckon__core__a_cpp="x = rand();\n")), 1)

    def test_files_name_their_licence(self):
        rule = source_rules.files_name_their_licence
        self.assertEqual(complaints(rule, src__a_cpp=SPDX, README_md="# Title\n"), [])
        self.assertEqual(len(complaints(rule, src__a_cpp="int x;\n")), 1)
        self.assertEqual(len(complaints(rule, quickstart="#!/bin/sh\n")), 1)

    def test_texts_stand_alone(self):
        rule = source_rules.texts_stand_alone
        self.assertEqual(complaints(rule, README_md="see ~/work/a and https://example.org/home/b\n"), [])
        for bad in ("/ho" "me/me/x", "# FIX" "ME", "issue #" "3", "pypi" ".org"):
            self.assertEqual(len(complaints(rule, README_md=bad)), 1, bad)

    def test_files_stay_short(self):
        rule = source_rules.files_stay_short
        self.assertEqual(complaints(rule, src__a_cpp="\n" * source_rules.LONGEST_FILE), [])
        self.assertEqual(len(complaints(rule, src__a_cpp="\n" * (source_rules.LONGEST_FILE + 1))), 1)

    def test_comments_are_blanked_in_place(self):
        text = 'a; // b\n/* c\nd */ e; "f // g"; R"(h\n"i)"; j'
        self.assertEqual(source_rules.without_comments(text), 'a; \n\n e; ""; ""\n; j')


if __name__ == "__main__":
    unittest.main()
