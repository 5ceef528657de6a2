#!/usr/bin/env python3
"""Tests what cmake/reference writes from the option table of the program.

usage: reference_test.py VANTAGE
"""
import gzip
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent / "cmake" / "reference"
PROGRAM = sys.argv.pop(1)


def options_in_help(words):
    """Long options that `vantage COMMAND --help-all` lists: written by other code."""
    text = subprocess.run([PROGRAM, *words, "--help-all"], check=True, capture_output=True,
                          text=True).stdout
    names = set()
    for line in text.splitlines():
        if line.startswith("  -"):
            names |= {name.split("=")[0] for name in line.split()[0].split(",")
                      if name.startswith("--")}
    return names


class ReferenceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        subprocess.run([sys.executable, "-B", SCRIPTS / "write.py", PROGRAM, cls.folder], check=True)
        commands = json.loads(subprocess.run([PROGRAM, "--help-json"], check=True,
                                             capture_output=True).stdout)["commands"]
        cls.commands = [command["name"] for command in commands]

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def page(self, command):
        file = self.folder / "man" / f"vantage-{command.replace(' ', '-')}.1.gz"
        return gzip.decompress(file.read_bytes()).decode()

    def completed(self, *words):
        """What bash offers for the last of `words`."""
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _vantage; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        return subprocess.run(["bash", "-c", script, "bash", self.folder / "bash" / "vantage",
                               "vantage", *words], check=True, capture_output=True,
                              text=True).stdout.split()

    def test_the_guide_lists_every_command(self):
        guide = (SCRIPTS.parent.parent / "docs" / "GUIDE.md").read_text(encoding="utf-8")
        table = guide.split("## All commands", 1)[1].split("\n## ", 1)[0]
        for command in self.commands:
            self.assertIn(f"`{command}`", table)

    def test_every_option_is_in_the_manual_the_pages_and_the_completion(self):
        self.assertGreater(len(self.commands), 15)
        for command in self.commands:
            options = options_in_help(command.split())
            self.assertGreater(len(options), 3, command)
            manual = self.page(command).replace("\\-", "-")
            markdown = (self.folder / "markdown" /
                        f"vantage-{command.replace(' ', '-')}.md").read_text()
            offered = self.completed(*command.split(), "--")
            zsh = (self.folder / "zsh" / "_vantage").read_text()
            for option in options:
                for place in (manual, markdown, zsh, offered):
                    self.assertIn(option, place, command)

    def test_manual_pages_have_no_errors(self):
        if shutil.which("groff") is None:
            self.skipTest("no groff")
        for command in self.commands:
            warnings = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z"], capture_output=True,
                                      input=self.page(command), text=True).stderr
            self.assertEqual(warnings, "", command)

    def test_bash_completes_commands_options_and_values(self):
        self.assertEqual(self.completed("sy"), ["synth"])
        self.assertEqual(self.completed("scene", "b"), ["build"])
        self.assertEqual(self.completed("match", "--output-r"), ["--output-right"])
        self.assertEqual(self.completed("match", "--preset", "bal"), ["balanced"])
        self.assertEqual(self.completed("scene", "build", "--preset", "bal"), ["balanced"])
        self.assertEqual(self.completed("match", "--output", ""), [])  # then files

    def test_zsh_completion_is_a_zsh_script(self):
        if shutil.which("zsh") is None:
            self.skipTest("no zsh")
        subprocess.run(["zsh", "-n", self.folder / "zsh" / "_vantage"], check=True)


if __name__ == "__main__":
    unittest.main()
