# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""bench/compare.py passes equal results and names what got worse."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

COMPARE = pathlib.Path(__file__).resolve().parents[2] / "bench" / "compare.py"


def result(ratio, same_bits=True):
    return {"workload": "dense", "machine": "m", "threads": 1, "size": "full", "ratio": ratio,
            "same_bits": same_bits, "near": {"ns_per_grain_step": 1000.0}}


class BenchCompare(unittest.TestCase):
    def compare(self, new, old):
        with tempfile.TemporaryDirectory() as folder:
            paths = []
            for name, text in (("new", new), ("old", old)):
                paths.append(pathlib.Path(folder) / name)
                paths[-1].mkdir()
                (paths[-1] / "dense.m.json").write_text(text)
            return subprocess.run([sys.executable, COMPARE, *paths], capture_output=True,
                                  text=True, check=False)

    def test_equal_results_pass(self):
        outcome = self.compare(json.dumps(result(20)), json.dumps(result(21)))
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        self.assertIn("0.95", outcome.stdout)

    def test_a_lower_ratio_fails(self):
        outcome = self.compare(json.dumps(result(15)), json.dumps(result(21)))
        self.assertEqual(outcome.returncode, 1)
        self.assertIn("slower", outcome.stdout)

    def test_bands_are_not_compared_with_whole_grids(self):
        outcome = self.compare(json.dumps({**result(10), "storage": "band"}),
                               json.dumps(result(21)))
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        self.assertIn("dense, band", outcome.stdout)
        self.assertIn("not yet measured", outcome.stdout)

    def test_other_bits_fail(self):
        outcome = self.compare(json.dumps(result(21, False)), json.dumps(result(21)))
        self.assertEqual(outcome.returncode, 1)
        self.assertIn("BITS DIFFER", outcome.stdout)

    def test_what_is_no_result_is_named(self):
        outcome = self.compare("[]", json.dumps(result(21)))
        self.assertEqual(outcome.returncode, 1)
        self.assertIn("dense.m.json is not a result", outcome.stderr)


if __name__ == "__main__":
    unittest.main()
