"""The page that `vantage profile` writes, in a headless Chromium.

usage: profile_page_test.py VANTAGE

Exits with 77 where there is no Chromium.
"""

import itertools
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from headless_browser import Browser, BrowserError, Tab, find_browser

EXIT_SKIPPED = 77
NAME = "<!-- <script> & \"so on\".pfm"  # which is no markup
WIDTHS = [1000, 1200, 1400]
BOXES = ("[...document.querySelectorAll('{}')].map((element) => (({{left, right, top, bottom}}) => "
         "({{left, right, top, bottom, text: element.textContent}}))"
         "(element.getBoundingClientRect()))")
# For each section its title, and the texts of its tables, row by row, of its notes and charts.
SECTIONS = """Object.fromEntries([...document.querySelectorAll("section")].map((section) => {
  const text = (element) => element.textContent.replaceAll("\\u00a0", " ");
  return [section.querySelector("h2").textContent, {
    rows: [...section.querySelectorAll("tbody tr")].map((row) => [...row.children].map(text)),
    texts: [...section.querySelectorAll("p, li")].map(text),
    labels: [...section.querySelectorAll("svg text:not(.tick)")].map(text),
    hints: [...section.querySelectorAll("svg title")].map(text)}];
}))"""


def sample(median, least=None, most=None):
    return {"median": median, "least": least or median, "most": most or median}


def made_up_count(threads, wall_s):
    """On one number of threads: two stages, of which one does not count its work."""
    return {
        "threads": threads, "runs": 5, "frames": 20,
        "wall_s": sample(wall_s, wall_s - 0.01, wall_s + 0.01),
        "compute_s": sample(0.25), "cells_per_s": sample(54.9e6), "frames_per_s": sample(0.0),
        "work_share": sample(0.88), "peak_memory_bytes": sample(80e6),
        "imbalance": sample(1.04, 1.03, 1.05),
        "stages": [
            {"name": "Bayes iteration", "seconds": sample(0.402, 0.39, 0.414), "columns": 2.56e6,
             "own_columns": 2.4e6, "cells": 164e6, "operations": 1.8e9, "bytes": 1.97e9,
             "work_share": 0.718, "ns_per_cell": 2.451, "cells_per_s": 408e6, "halo_share": 0.067,
             "gb_per_s": 4.9, "gflops": 4.488,
             "roofline": {"operations_per_byte": 0.914, "roof": "arithmetic", "roof_gflops": 118.0,
                          "roof_share": 0.038, "memory_share": 0.5}},
            {"name": "cost", "seconds": sample(0.0712), "columns": 0.0, "own_columns": 0.0,
             "cells": 0.0, "operations": 0.0, "bytes": 0.0, "work_share": 0.127,
             "ns_per_cell": 0.0, "cells_per_s": 0.0, "halo_share": 0.0, "gb_per_s": 0.0,
             "gflops": 0.0, "roofline": None}],
        "parts": [{"name": "match left", "seconds": sample(0.5, 0.48, 0.51),
                   "processor_s": sample(0.49), "count": 24.0},
                  {"name": "fill", "seconds": sample(0.0002), "processor_s": sample(0.0002),
                   "count": 39.0},
                  {"name": "<b>", "seconds": sample(0.0001), "processor_s": sample(0.0001),
                   "count": 1.0}],
        "waits": [{"name": "idle", "seconds": sample(0.064), "processor_s": sample(0.0),
                   "count": 1.28e6}],
        "waiting_for": {"reading_s": sample(0.0), "computing_s": sample(0.016),
                        "writing_s": sample(0.032), "nothing_s": sample(0.016)},
        "workers": [{"name": "main", "is_in_pool": True, "work_s": 0.3, "wait_s": 0.02},
                    {"name": "worker 1", "is_in_pool": True, "work_s": 0.26, "wait_s": 0.06},
                    {"name": "deliveries", "is_in_pool": False, "work_s": 0.01, "wait_s": 0.0}],
        "pool_work_s": 0.56, "pool_time_s": 0.64,
        "roofs": {"gflops": 118.0, "l2_gb_per_s": 136.0, "memory_gb_per_s": 9.75}}


MADE_UP = {
    "profile_schema": 1, "version": "9.8.7", "command": "vantage match </script><i>.png",
    "date": "2026-03-09T11:45:10Z", "processor": "Example 9000", "isa": "AVX3",
    "hardware_threads": 2, "peak_memory_bytes": 81_698_816,
    "ceilings": [{"threads": threads, "core_gflops": 120.0, "all_gflops": 118.0 * threads,
                  "core_l2_gb_per_s": 140.0, "all_l2_gb_per_s": 136.0 * threads,
                  "core_memory_gb_per_s": 12.0, "all_memory_gb_per_s": 9.75 * threads}
                 for threads in (1, 2)],
    "thread_counts": [made_up_count(1, 0.58), made_up_count(2, 0.32)],
    "speed_ups": [{"threads": 1, "ratio": sample(1.0), "efficiency": 1.0, "serial_fraction": None},
                  {"threads": 2, "ratio": sample(1.81, 1.78, 1.84), "efficiency": 0.906,
                   "serial_fraction": 0.103}],
    "serial_fraction": 0.0901,
    "processor_growth": [{"name": "match left", "kind": "part", "ms": [25.0, 26.0],
                          "growth": [0.0, 0.04]}],
    "memory": [{"name": "rings", "bytes": 21_200_000}, {"name": "maps", "bytes": 12_900_000}],
    "timeline_s": 0.32,
    "timeline": [
        {"thread": "deliveries", "is_in_pool": False, "spans": [
            {"name": "deliver", "is_wait": False, "begin_s": 0.3, "end_s": 0.31, "frame": 20}]},
        {"thread": "main", "is_in_pool": True, "spans": [
            {"name": "match left", "is_wait": False, "begin_s": 0.0, "end_s": 0.2, "frame": 21},
            {"name": "idle", "is_wait": True, "begin_s": 0.2, "end_s": 0.32, "frame": -1}]}],
    "advice": ["--preset realtime, for instance."], "findings": ["The stage takes 72 % of the work."]}


def empty_profile():
    return {**MADE_UP, **{key: [] for key in ("ceilings", "thread_counts", "speed_ups", "memory",
                                              "timeline", "advice", "findings")},
            "serial_fraction": None, "peak_memory_bytes": 0, "timeline_s": 0.0}


def without_figures(value):
    """The same with null for all that is not a whole number, as what is not finite is written."""
    if isinstance(value, dict):
        return {key: without_figures(member) for key, member in value.items()}
    if isinstance(value, list):
        return [without_figures(member) for member in value]
    return None if isinstance(value, float) else value


def keys_of(value, path=""):
    """Where there are keys in a JSON value; of a list, those of its first member."""
    if isinstance(value, list):
        return keys_of(value[0], path + "[]") if value else set()
    if not isinstance(value, dict):
        return {path}
    return set().union(*(keys_of(member, f"{path}.{key}") for key, member in value.items()))


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
        cls.json = cls.folder / "profile.json"
        vantage("profile", "--runs", "2", "--threads", "1,2", "--html", cls.page,
                "--json", cls.json, "match", scene / "left.png", scene / "right.png",
                "--method", "bayes", "-o", cls.folder / NAME)
        cls.browser = cls.enterClassContext(Browser())

    def open(self, width=1200, page=None):
        tab = Tab(self.browser, (page or self.page).as_uri(), width=width, height=900)
        self.addCleanup(tab.close)
        return tab

    def open_with(self, profile):
        """The page with another profile in it."""
        head, rest = self.page.read_text().split('id="profile">', 1)
        page = self.folder / "made up.html"
        page.write_text(head + 'id="profile">' + json.dumps(profile).replace("<", "\\u003c") +
                        rest[rest.index("</script>"):])
        tab = self.open(page=page)
        self.assertEqual(tab.complaints(), [])
        return tab

    def test_shows_every_figure_of_a_made_up_profile(self):
        self.assertEqual(keys_of(MADE_UP), keys_of(json.loads(self.json.read_text())))
        tab = self.open_with(MADE_UP)
        self.assertEqual(tab.text("command"), MADE_UP["command"])
        self.assertEqual(tab.text("facts"),
                         "processorExample 9000hardware threads2instruction setAVX3"
                         "date2026-03-09T11:45:10ZVantage9.8.7")
        figures = [[text.replace("\u00a0", " ") for text in row] for row in tab.evaluate(
            "[...document.querySelectorAll('.figures div')].map("
            "(figure) => [...figure.children].map((part) => part.textContent))")]
        self.assertEqual(figures, [
            ["wall time on 2 threads", "320 ms", "median of 5 runs, 310 ms to 330 ms"],
            ["cells per second", "54.9 M", "54.9 M to 54.9 M"],
            ["threads work", "88 %", "of their time; else they wait"],
            ["speed-up, 1 to 2 threads", "1.81×", "efficiency 91 %"],
            ["serial fraction", "9.0 %", "of Amdahl's law as fitted"],
            ["peak memory", "81.7 MB", "resident, of the process"]])
        sections = tab.evaluate(SECTIONS)
        self.assertEqual({title: section["rows"] for title, section in sections.items()}, {
            "What you can do about the time": [],
            "What holds it back": [],
            "Stages": [
                ["Bayes iteration", "402 (390–414) ms", "72 %", "2.45", "408 M", "6.7 %", "4.90",
                 "4.49", "3.8 % arithmetic"],
                ["cost", "71.2 ms", "13 %", "–", "–", "–", "–", "–", "–"]],
            "Roofline": [["arithmetic, GFLOP/s", "120", "236"], ["level 2, GB/s", "140", "272"],
                         ["memory, GB/s", "12.0", "19.5"]],
            "Timeline": [],
            "Where the threads' time goes": [
                ["match left", "500 (480–510) ms", "78 %", "24"],
                ["2 more, each below 0.10 %", "300 µs", "0.05 %", "40"],
                ["idle (waiting)", "64.0 ms", "10 %", "1.28 M"]],
            "Use of threads": [
                ["main", "94 %", "300 ms", "20.0 ms"], ["worker 1", "81 %", "260 ms", "60.0 ms"],
                ["deliveries (outside the pool)", "", "10.0 ms", "–"]],
            "What waiting threads wait for": [
                ["images being read or decoded", "0 s", "0 %"],
                ["tasks of other threads", "16.0 ms", "2.5 %"],
                ["results being encoded or written", "32.0 ms", "5.0 %"],
                ["nothing that was recorded: start, end, steps without tasks", "16.0 ms", "2.5 %"]],
            "Speed-up with threads": [
                ["1", "5", "580 (570–590) ms", "250 ms", "54.9 M", "88 %", "1.00×", "100 %", "–"],
                ["2", "5", "320 (310–330) ms", "250 ms", "54.9 M", "88 %", "1.81 (1.78–1.84)×",
                 "91 %", "10 %"]],
            "Memory": [["rings", "21.2 MB", "26 %"], ["maps", "12.9 MB", "16 %"]]})
        self.assertEqual(sections["Timeline"]["labels"],
                         ["", "time, ms", "main", "21", "deliveries", "20"])
        self.assertEqual(sections["Roofline"]["labels"][2:],
                         ["memory 9.75 GB/s", "L2 136 GB/s", "arithmetic 118 GFLOP/s",
                          "Bayes iteration"])
        for title, kind, text in [
                ("What you can do about the time", "texts", "--preset realtime, for instance."),
                ("What holds it back", "texts", "The stage takes 72 % of the work."),
                ("Roofline", "texts", "Not drawn, as they do not count their work: cost."),
                ("Roofline", "hints", "Bayes iteration: 402 ms of a thread, 4.49 GFLOP/s, "
                 "4.90 GB/s, 0.914 operations per byte, 3.8 % of its roof (arithmetic)"),
                ("Timeline", "hints", "match left, frame 21: 200 ms from 0 s"),
                ("Timeline", "hints", "idle: 120 ms from 200 ms"),
                ("Use of threads", "texts",
                 "The busiest thread of the pool works 1.04 (1.03–1.05) times the mean."),
                ("Speed-up with threads", "hints", "2 threads: 1.81 (1.78–1.84)×"),
                ("Memory", "texts", "At most 81.7 MB were resident.")]:
            self.assertIn(text, sections[title][kind])

    def test_says_what_is_missing(self):
        no_ceilings = {**MADE_UP, "ceilings": [],
                       "thread_counts": [{**made_up_count(1, 0.58), "roofs": None}],
                       "speed_ups": MADE_UP["speed_ups"][:1], "serial_fraction": None}
        untraced = {**made_up_count(1, 0.58), "workers": [], "parts": [], "waits": [],
                    "waiting_for": {key: sample(0.0) for key in
                                    ("reading_s", "computing_s", "writing_s", "nothing_s")}}
        for profile, texts in [
                (empty_profile(), ["No run was measured.", "not enough to say what holds it back",
                                   "No stage of matching", "no timeline",
                                   "memory was used is not known"]),
                (no_ceilings, ["ceilings were not measured", "there is no speed-up"]),
                ({**MADE_UP, "thread_counts": [untraced]},
                 ["time went is not known", "thread worked is not known",
                  "No waiting was recorded."])]:
            page = self.open_with(profile).evaluate("document.querySelector('main').textContent")
            for text in texts:
                self.assertIn(text, page)

    def test_figures_that_are_unknown_are_dashes(self):
        tab = self.open_with(without_figures(MADE_UP))
        page = tab.evaluate("document.body.innerText + [...document.querySelectorAll('svg')]"
                            ".map((svg) => svg.outerHTML)")
        self.assertIn("–", page)
        self.assertNotRegex(page, r"\b(NaN|Infinity|undefined|null)\b")

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
        self.assertIn(NAME, tab.text("command"))
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
        # In a narrower window wide tables scroll by themselves.
        self.assertLessEqual(self.open(500).evaluate("document.documentElement.scrollWidth"), 500)

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
