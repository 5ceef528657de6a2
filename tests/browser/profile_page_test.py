"""The page that `vantage profile` writes, in a headless Chromium.

usage: profile_page_test.py VANTAGE

Exits with 77 where there is no Chromium.
"""

import itertools
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from headless_browser import Browser, BrowserError, Tab, find_browser

EXIT_SKIPPED = 77
WIDTHS = [1000, 1200, 1400]
BOXES = ("[...document.querySelectorAll('{}')].map((element) => (({{left, right, top, bottom}}) => "
         "({{left, right, top, bottom, text: element.textContent}}))"
         "(element.getBoundingClientRect()))")


def vantage(*arguments):
    result = subprocess.run([VANTAGE, *map(str, arguments)], capture_output=True, text=True,
                            timeout=500, check=False)
    if result.returncode != 0:
        raise AssertionError(f"{result.args} exits with {result.returncode}: {result.stderr}")


def why_impossible():
    if not find_browser():
        return "there is no chromium"
    try:
        with Browser():
            return None
    except (BrowserError, OSError) as error:
        return f"chromium does not run here: {error}"


def overlap(a, b):
    return (a["left"] < b["right"] and b["left"] < a["right"]
            and a["top"] < b["bottom"] and b["top"] < a["bottom"])


class ProfilePageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        scene = cls.folder / "scene"
        vantage("generate", "scene", "-o", scene, "--width=240", "--height=180")
        cls.page = cls.folder / "page & <100%>.html"
        vantage("profile", "--runs", "2", "--threads", "1,2", "--html", cls.page,
                "match", scene / "left.png", scene / "right.png", "--method", "bayes",
                "-o", cls.folder / "disparity <i> & \"so on\".pfm")
        cls.browser = cls.enterClassContext(Browser())

    def open(self, width=1200):
        tab = Tab(self.browser, self.page.as_uri(), width=width, height=900)
        self.addCleanup(tab.close)
        return tab

    def test_loads_nothing_and_has_no_errors(self):
        tab = self.open()
        self.assertEqual([url for url in tab.requests() if not url.startswith("file:")], [])
        self.assertEqual(tab.complaints(), [])
        self.assertEqual(tab.evaluate("document.compatMode"), "CSS1Compat")
        # What would have been seen.
        tab.evaluate("new Promise((resolve) => { const image = new Image();"
                     "image.onerror = resolve; image.src = 'http://127.0.0.1:9/a.png'; })")
        self.assertNotEqual(tab.complaints(), [])

    def test_shows_the_command_and_every_chart(self):
        tab = self.open()
        self.assertIn("disparity <i> & \"so on\".pfm",
                      tab.evaluate("document.querySelector('h1').textContent"))
        titles = [box["text"] for box in tab.evaluate(BOXES.format("h2"))]
        for title in ["What holds it back", "Stages", "Roofline", "Timeline", "Use of threads",
                      "Speed-up with threads", "Memory", "Hardware counters"]:
            self.assertIn(title, titles)
        charts = tab.evaluate("[...document.querySelectorAll('svg')].map((svg) => ["
                              "svg.getAttribute('aria-label'), svg.clientWidth, svg.clientHeight])")
        self.assertEqual(len(charts), 3)
        for label, width, height in charts:
            self.assertTrue(label)
            self.assertGreater(width, 300)
            self.assertGreater(height, 60)
        self.assertIn("Bayes iteration", [box["text"] for box in tab.evaluate(BOXES.format("th"))])

    def test_nothing_sticks_out_sideways(self):
        for width in WIDTHS:
            with self.subTest(width=width):
                tab = self.open(width)
                self.assertLessEqual(tab.evaluate("document.documentElement.scrollWidth"), width)
                for box in tab.evaluate(BOXES.format("table, svg, .figures div")):
                    self.assertLessEqual(box["right"], width, box)
                # Tables and charts beside each other keep apart.
                for a, b in itertools.combinations(tab.evaluate(BOXES.format("table, svg")), 2):
                    self.assertFalse(overlap(a, b), (a, b))

    def test_labels_of_the_roofline_can_be_read(self):
        labels = self.open().evaluate(BOXES.format("svg .label, svg .roof-name"))
        self.assertGreaterEqual(len(labels), 4)
        for a, b in itertools.combinations(labels, 2):
            self.assertFalse(overlap(a, b), (a, b))

    def test_follows_the_wish_for_dark(self):
        tab = self.open()
        for scheme, is_dark in [("light", False), ("dark", True)]:
            tab.call("Emulation.setEmulatedMedia",
                     features=[{"name": "prefers-color-scheme", "value": scheme}])
            levels = tab.evaluate("getComputedStyle(document.body).backgroundColor"
                                  ".match(/[0-9]+/g).map(Number)")
            self.assertEqual(sum(levels[:3]) < 384, is_dark, levels)


if __name__ == "__main__":
    VANTAGE = sys.argv[1]
    if reason := why_impossible():
        print(f"skipped: {reason}")
        sys.exit(EXIT_SKIPPED)
    unittest.main(argv=sys.argv[:1], verbosity=2)
