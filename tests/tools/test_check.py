# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""./check counts the results of the test runner, and never hides a failure."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import check  # noqa: E402  (the path above comes first)

# As ctest 3.25 writes it.
REPORT = """<testsuite>
<testcase name="a" status="run"><system-out>fine</system-out></testcase>
<testcase name="b" status="fail"><failure message="Failed"/><system-out>one is two</system-out></testcase>
<testcase name="c" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/></testcase>
<testcase name="d" status="{last}">{why}</testcase>
</testsuite>"""


class Counting(unittest.TestCase):
    def counted(self, report, verdict):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "report.xml"
            path.write_text(report)
            check.count_tests(path, verdict)
        return verdict

    def test_runs_failures_and_skips(self):
        outcome = self.counted(REPORT.format(last="run", why=""), check.Outcome(0, 1))
        self.assertEqual((outcome.passed, outcome.failed, outcome.skipped), (2, 1, 1))
        self.assertIn("one is two", outcome.details)

    def test_a_test_that_could_not_start_has_failed(self):
        outcome = self.counted(REPORT.format(last="notrun", why='<skipped message="Unable to find executable"/>'),
                               check.Outcome(0, 1))
        self.assertEqual((outcome.passed, outcome.failed, outcome.skipped), (1, 2, 1))

    def test_a_failed_runner_is_a_failure_even_without_a_failed_test(self):
        outcome = self.counted("<testsuite/>", check.Outcome(0, 1))
        self.assertEqual(outcome.failed, 1)

    def test_a_failing_command_shows_its_last_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "log"
            outcome = check.run(log, ["echo", "first"], ["sh", "-c", "echo told; exit 3"], ["echo", "never"])
        self.assertEqual(outcome.failed, 1)
        self.assertIn("told", outcome.details)
        self.assertNotIn("never", outcome.details)

    def test_a_missing_command_fails(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(check.run(pathlib.Path(folder) / "log", ["no-such-program"]).failed, 1)


if __name__ == "__main__":
    unittest.main()
