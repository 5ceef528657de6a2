#!/usr/bin/env python3
"""Tests what the page of scripts/demo says of a match.

usage: demo_report_test.py VANTAGE
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "scripts" / "lib"))
import demo_report  # noqa: E402

PROGRAM = sys.argv.pop(1)


class DemoReportTest(unittest.TestCase):
    def test_the_method_is_the_one_that_matched(self):
        with tempfile.TemporaryDirectory() as folder:
            for words in (["generate", "scene", "-o", ".", "--width", "64", "--height", "48"],
                          ["match", "left.png", "right.png", "-o", "map.pfm", "--disparities",
                           "0:7", "--report", "report.json"]):
                subprocess.run([PROGRAM, *words, "--quiet"], check=True, cwd=folder)
            report = json.loads((pathlib.Path(folder) / "report.json").read_text())
        text = demo_report.method_text(report["settings"])
        self.assertRegex(text, r"^Preset \w+: cost [\w-]+, aggregation \w+, \d+ levels, "
                               r"disparities 0 to 7 px$")
        self.assertNotIn("auto", text)


if __name__ == "__main__":
    unittest.main()
