"""Tests of scripts that check a source tree: one violation at a time is planted in a small tree."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path


class PlantedTreeTest(unittest.TestCase):
    """Subclasses name their script beside this file and a tree without violations, path to text."""

    script = ""
    clean_tree = {}

    def check(self, tree):
        with tempfile.TemporaryDirectory() as root:
            for name, text in tree.items():
                file = Path(root) / name
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            return subprocess.run(
                [sys.executable, "-B", str(Path(__file__).parent / self.script), root],
                capture_output=True, text=True, check=False)

    def expect_violation(self, name, text, expected_line):
        result = self.check({**self.clean_tree, name: text})
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertEqual(len(result.stdout.splitlines()), 2, result.stdout)
        self.assertIn(expected_line, result.stdout)

    def expect_clean(self):
        result = self.check(self.clean_tree)
        self.assertEqual(result.returncode, 0, result.stdout)
