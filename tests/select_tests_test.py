"""Has scripts/lib/select_tests.py choose from tests made up for it."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SELECT_TESTS = Path(__file__).parent.parent / "scripts" / "lib" / "select_tests.py"

CENSUS = """
TEST(CensusTables, AreSmall) {}
TEST_P(Census, EqualsThePlainOne) {
"""
RUN = """
TEST_F(RunTest, Resumes) {}
TEST_F(RunTest, Ends) {}
"""


def select(pattern):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (("kernels/census_test.cc", CENSUS), ("apps/run_test.cc", RUN)):
            file = Path(folder, "tests", name)
            file.parent.mkdir(parents=True)
            file.write_text(text, encoding="utf-8")
        return subprocess.run([sys.executable, "-B", str(SELECT_TESTS), pattern], cwd=folder,
                              capture_output=True, text=True, check=False)


class SelectTests(unittest.TestCase):
    def test_all_suites_of_a_file_that_matches(self):
        folder, filters = select("kernels/census").stdout.split()
        self.assertEqual(folder, "kernels")
        self.assertIn("CensusTables.*", filters.split(":"))
        self.assertIn("*/Census.*/*", filters.split(":"))

    def test_single_tests_by_name(self):
        folder, filters = select("runtest.RESUMES").stdout.split()
        self.assertEqual(folder, "apps")
        self.assertIn("RunTest.Resumes", filters.split(":"))
        self.assertNotIn("Ends", filters)

    def test_tests_of_several_folders(self):
        lines = select("census_test|Ends").stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines], ["kernels", "apps"])

    def test_nothing_matches(self):
        self.assertEqual(select("nowhere").stdout, "")

    def test_a_broken_pattern_is_a_clear_error(self):
        done = select("(")
        self.assertEqual(done.returncode, 1)
        self.assertIn("'(' is not a regular expression", done.stderr)


unittest.main()
