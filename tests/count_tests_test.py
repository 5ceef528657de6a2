"""Has scripts/lib/count_tests.py add up made-up results."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

COUNT_TESTS = Path(__file__).parent.parent / "scripts" / "lib" / "count_tests.py"

PASSED = '<testcase name="p" status="run" result="completed"/>'
FAILED = '<testcase name="f" status="run" result="completed"><failure message="x"/></testcase>'
SKIPPED = '<testcase name="s" status="run" result="skipped"><skipped message="x"/></testcase>'
DISABLED = '<testcase name="d" status="notrun" result="suppressed"/>'


def shard(failed):
    if failed:
        return '<testcase name="engine/shard-1-of-1" status="fail"><failure message=""/></testcase>'
    return '<testcase name="engine/shard-1-of-1" status="run"/>'


def count(results, report=None):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "results.xml"
        file.write_text(f"<testsuite>{results}</testsuite>", encoding="utf-8")
        if report is not None:
            of_shard = Path(folder) / "engine" / "shard-1-of-1.xml"
            of_shard.parent.mkdir()
            of_shard.write_text(f"<testsuites><testsuite>{report}</testsuite></testsuites>",
                                encoding="utf-8")
        printed = subprocess.run([sys.executable, "-B", str(COUNT_TESTS), str(file), folder],
                                 capture_output=True, text=True, check=True).stdout
        return [int(number) for number in printed.split()]


class CountTests(unittest.TestCase):
    def test_of_processes_of_their_own(self):
        self.assertEqual(count('<testcase name="layers" status="run"/>'
                               '<testcase name="apps/A" status="fail"><failure message=""/></testcase>'
                               '<testcase name="apps/S" status="notrun"><skipped message=""/></testcase>'),
                         [1, 1, 1])

    def test_those_that_share_a_process_are_in_its_report(self):
        self.assertEqual(count(shard(False), PASSED + PASSED + SKIPPED + DISABLED), [2, 0, 2])
        self.assertEqual(count(shard(True), PASSED + FAILED + FAILED), [1, 2, 0])

    def test_a_process_that_ends_badly_counts_as_failed(self):
        self.assertEqual(count(shard(True)), [0, 1, 0], "before its last test")
        self.assertEqual(count(shard(True), PASSED + PASSED), [2, 1, 0], "after it")
        self.assertEqual(count(shard(False)), [0, 1, 0], "without a word")


unittest.main()
