"""The page that matches in the browser, in a headless Chromium: browser_page_test.py VANTAGE PAGE

PAGE is built by the preset wasm. Exits with 77 where it, or a Chromium that draws, is not there, and
unless VANTAGE_TEST_ALL is set: the page has to be of the same sources as the program.
"""

import base64
import os
import statistics
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from headless_browser import Browser, Tab
from view_page_test import EXIT_SKIPPED, tests_all_cases, why_impossible

MOST_BYTES = 6_000_000
WAITING = """new Promise((resolve) => { const look = () => {
  const {status} = document.documentElement.dataset;
  if (STATES.includes(status)) { resolve(status); } else { setTimeout(look, 20); } }; look(); })"""
# What a button saves, as base64 instead of a file.
KEPT = """HTMLAnchorElement.prototype.click = async function() {
  const bytes = new Uint8Array(await (await keptBlob).arrayBuffer());
  let text = ''; for (const byte of bytes) { text += String.fromCharCode(byte); }
  window.kept = btoa(text); };
const make = URL.createObjectURL;
URL.createObjectURL = (blob) => { window.keptBlob = blob; return make(blob); };"""


def vantage(*arguments):
    subprocess.run([VANTAGE, *map(str, arguments), "--quiet"], check=True, timeout=300)


class BrowserPageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.scene = cls.folder / "scene"
        vantage("generate", "scene", "-o", cls.scene, "--width=640", "--height=480", "--samples=1",
                "--noise=2")
        cls.browser = cls.enterClassContext(Browser("--allow-file-access-from-files=false"))

    def setUp(self):
        self.tab = Tab(self.browser, PAGE.as_uri(), width=1200, height=900, script=KEPT)
        self.addCleanup(self.tab.close)
        self.tab.call("Emulation.setEmulatedMedia",  # moving views take the processor's time
                      features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
        self.comes_to("ready")

    def comes_to(self, *states):
        status = self.tab.evaluate(WAITING.replace("STATES", str([*states, "failed"])))
        self.assertIn(status, states, (self.tab.text("error"), self.tab.complaints()))

    def give(self, **files):
        document = self.tab.call("DOM.getDocument")["root"]["nodeId"]
        for side, file in files.items():
            node = self.tab.call("DOM.querySelector", nodeId=document, selector=f"#{side}")["nodeId"]
            self.tab.call("DOM.setFileInputFiles", files=[str(file)], nodeId=node)

    def match(self, *states, **values):
        self.tab.evaluate("".join(f"document.getElementById('{name}').value = '{value}';"
                                  for name, value in values.items())
                          + "document.getElementById('match').click();")
        self.comes_to(*states)

    def kept(self, button):
        content = self.tab.evaluate(
            f"(async () => {{ window.kept = null; document.getElementById('{button}').click();"
            " while (!window.kept) { await new Promise((done) => setTimeout(done, 20)); }"
            " return kept; })()")
        return base64.b64decode(content)

    def test_maps_are_those_of_the_program(self):
        pair = [self.scene / "left.png", self.scene / "right.png"]
        self.give(left=pair[0], right=pair[1])
        for preset, disparities in [("realtime", "auto"), ("balanced", "auto"), ("quality", "0:47")]:
            self.match("matched", "shown", preset=preset, disparities=disparities)
            expected = self.folder / "map.pfm"
            vantage("match", *pair, "-o", expected, "--preset", preset, "--disparities", disparities)
            self.assertEqual(self.kept("save-map"), expected.read_bytes(), preset)
        self.comes_to("shown")
        self.assertRegex(self.tab.text("value"), r"^\(320, 240\): \d+\.\d\d px$")

    def test_views_are_those_of_the_page_that_view_writes(self):
        self.give(left=self.scene / "left.png", right=self.scene / "right.png")
        self.match("shown", preset="realtime", disparities="0:47")
        self.assertEqual(self.tab.complaints(), [])
        page, expected = self.kept("save-view").decode(), self.folder / "expected.html"
        vantage("view", self.scene / "left.png", self.scene / "right.png", "-o", expected,
                "--preset", "realtime", "--disparities", "0:47")
        # The browser's PNG files are others, so the numbers around them.
        before = '"intensity":'
        for text in [page, expected.read_text()]:
            self.assertEqual(text.count(before), 1)
        numbers = [text[text.index("Film.deliver("):text.index('"type":')]
                   for text in [page, expected.read_text()]]
        self.assertEqual(*numbers)

    def test_one_picture_has_both_eyes(self):
        both = self.folder / "both.png"
        subprocess.run(["/usr/bin/python3", "-c", "import cv2, sys; cv2.imwrite(sys.argv[3], cv2.hconcat("
                        "[cv2.imread(name) for name in sys.argv[1:3]]))", self.scene / "left.png",
                        self.scene / "right.png", both], check=True)
        self.give(left=both)
        self.match("matched", "shown", preset="realtime", disparities="auto", size="0.3")
        self.assertIn("one picture of 1280×480: its left half", self.tab.text("remarks"))
        self.assertIn("were reduced to 632×474 pixels", self.tab.text("remarks"))

    def test_errors_are_told(self):
        self.tab.evaluate("document.getElementById('match').click()")
        self.assertEqual(self.tab.text("error"), "Choose pictures first")
        no_picture, small = self.folder / "text.png", self.folder / "right.png"
        no_picture.write_text("no picture")
        vantage("generate", "scene", "-o", self.folder, "--width=320", "--height=240", "--samples=1")
        for right, disparities, expected in [
                (no_picture, "auto", "text.png: this browser cannot read it as a picture"),
                (small, "auto", "both must have the same size"),
                (self.scene / "right.png", "many", "disparities")]:
            self.give(left=self.scene / "left.png", right=right)
            self.match("failed", disparities=disparities)
            self.assertIn(expected, self.tab.text("error"))
        self.match("matched", disparities="auto")  # and it goes on

    def test_nothing_leaves_the_page(self):
        self.assertLessEqual(PAGE.stat().st_size, MOST_BYTES)
        self.tab.evaluate("document.getElementById('example').click()")
        self.comes_to("shown")
        schemes = {address.split(":")[0] for address in self.tab.requests()}
        self.assertLessEqual(schemes, {"file", "blob", "data", "about"})
        reached = self.tab.evaluate("fetch('http://127.0.0.1:9').then(() => true, () => false)")
        self.assertFalse(reached)
        self.assertTrue(any("Content Security Policy" in text for text in self.tab.complaints()))

    def test_time(self):
        self.give(left=self.scene / "left.png", right=self.scene / "right.png")
        for preset in ["realtime", "balanced"]:
            for disparities in ["auto", "0:63"]:
                seconds = []
                for _ in range(5):
                    self.match("shown", preset=preset, disparities=disparities)
                    seconds.append(float(self.tab.text("status").split()[-2]))
                print(f"640x480, {preset}, {disparities}: {statistics.median(seconds)} s",
                      file=sys.stderr)


if __name__ == "__main__":
    PAGE, VANTAGE = Path(sys.argv.pop()).resolve(), sys.argv.pop()
    REASON = ("VANTAGE_TEST_ALL=1 runs it" if not tests_all_cases() else
              f"there is no {PAGE}" if not PAGE.is_file() else why_impossible())
    if REASON:
        print(f"skipped: {REASON}")
        sys.exit(EXIT_SKIPPED)
    unittest.main()
