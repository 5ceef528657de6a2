"""The page that `vantage view` writes, in a headless Chromium.

usage: view_page_test.py VANTAGE DATA

DATA is a folder of real scenes; without it a test is skipped. Exits with 77 where there is no
Chromium, or one that cannot draw.
"""

import base64
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from headless_browser import Browser, BrowserError, Tab, find_browser

EXIT_SKIPPED = 77
SIZE = {"width": 160, "height": 120}
# What synth and the page do differently: one fit of intensities for all views instead of one for
# each, 16 bits of a disparity, single precision. That is worth a grey level here and there. Where
# s·d ends in exactly ½, as it often does for maps in half pixels, rounding may move a pixel at the
# edge of an object, and a hole beside it is filled otherwise: outside the baseline that shows.
LEAST_PSNR_DB = {"between": 60, "outside": 42}
NO_SERVER = "http://127.0.0.1:9"


def vantage(*arguments):
    result = subprocess.run([VANTAGE, *map(str, arguments)], capture_output=True, text=True,
                            timeout=300, check=False)
    if result.returncode != 0:
        raise AssertionError(f"{result.args} exits with {result.returncode}: {result.stderr}")


def tests_all_cases():
    """Whether what takes long and repeats is to be tested as well."""
    return os.environ.get("VANTAGE_TEST_ALL", "0") not in ("", "0")


def why_impossible():
    if not find_browser():
        return "there is no chromium"
    try:
        with Browser() as browser:
            tab = Tab(browser, "about:blank")
            if not tab.evaluate("!!document.createElement('canvas').getContext('webgl2')"):
                return "chromium has no WebGL 2 here"
    except (BrowserError, OSError) as error:
        return f"chromium does not run here: {error}"
    return None


def read_pnm(file):
    """Width, height, RGB bytes."""
    content = file.read_bytes()
    header = re.match(rb"P([56])\s+(\d+)\s+(\d+)\s+255\s", content)
    pixels = content[header.end():]
    if header[1] == b"5":
        pixels = bytes(value for value in pixels for _ in range(3))
    return int(header[2]), int(header[3]), pixels


def psnr_db(a, b):
    squares = sum((p - q) ** 2 for p, q in zip(a, b, strict=True))
    return math.inf if squares == 0 else 10 * math.log10(255 ** 2 * len(a) / squares)


def status_of(tab):
    """"ready" or "failed", once the page has drawn its first view or cannot."""
    return tab.evaluate("new Promise((resolve) => { const look = () => {"
                        " const {status} = document.documentElement.dataset;"
                        " if (status) { resolve(status); } else { setTimeout(look, 10); } };"
                        " look(); })")


class ViewPageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        scene = cls.folder / "scene"
        vantage("generate", "scene", "-o", scene,
                *(f"--{name}={value}" for name, value in SIZE.items()))
        cls.pair = [scene / "left.png", scene / "right.png",
                    "--left-disparity", scene / "left-disparity.pfm",
                    "--right-disparity", scene / "right-disparity.pfm"]
        cls.page = cls.folder / "page & <100%>.html"
        vantage("view", *cls.pair, "-o", cls.page)
        cls.browser = cls.enterClassContext(Browser())

    def open(self, address="", page=None, status="ready"):
        # Small: the processor draws, and what is drawn while the view moves takes most of the time.
        tab = Tab(self.browser, (page or self.page).as_uri() + address, width=400, height=400)
        self.addCleanup(tab.close)
        self.assertEqual(status_of(tab), status,
                         (tab.text("message"), tab.complaints()))
        return tab

    def rgb_of(self, name):
        """Of a picture of the scene: width, height, RGB bytes."""
        converted = self.folder / "converted.ppm"
        vantage("synth", *self.pair, "--view", "0" if name == "left.png" else "1", "-o", converted)
        return read_pnm(converted)

    def arrives_at(self, tab, x, y):
        """Movement is smooth, so it takes some frames; they must come to an end."""
        wanted = f"{x:.3f},{y:.3f}"
        result = tab.evaluate(
            "new Promise((resolve) => { const look = () => {"
            "  const now = ['x', 'y'].map((axis) => document.getElementById(`${axis}-value`)"
            f"    .textContent).join(); if (now === '{wanted}' || performance.now() > end) {{"
            "      resolve(now); } else { requestAnimationFrame(look); } };"
            " const end = performance.now() + 60000; look(); })")
        self.assertEqual(result, wanted)

    def expect_synthesized_views(self, page, pair, positions):
        """Compares with synth at (x, y) → "between" or "outside"."""
        tab = self.open("#render=native," + ",".join(f"x={x},y={y}" for x, y in positions), page)
        views = tab.evaluate("[...document.querySelectorAll('pre.pixels')].map((pre) => "
                             "({...pre.dataset, pixels: pre.textContent}))")
        self.assertEqual([(view["x"], view["y"]) for view in views], list(positions))
        for view in views:
            x, y = view["x"], view["y"]
            with self.subTest(page=page.name, x=x, y=y):
                expected = self.folder / ("synth.pgm" if pair[0].suffix == ".pgm" else "synth.ppm")
                vantage("synth", *pair, "--view", f"{x},{y}", "-o", expected)
                width, height, pixels = read_pnm(expected)
                self.assertEqual((int(view["width"]), int(view["height"])), (width, height))
                psnr = psnr_db(base64.b64decode(view["pixels"]), pixels)
                print(f"{page.name} at ({x}, {y}): {psnr:.1f} dB", file=sys.stderr)
                self.assertGreaterEqual(psnr, LEAST_PSNR_DB[positions[x, y]])
        self.assertEqual(tab.complaints(), [])

    def test_views_are_those_of_synth(self):
        self.expect_synthesized_views(self.page, self.pair, {
            ("0.5", "0"): "between", ("0", "0"): "between", ("0.25", "0"): "between",
            ("1", "0"): "between", ("-0.5", "0"): "outside", ("1.5", "0"): "outside",
            ("0.5", "0.2"): "between", ("1.25", "-0.1"): "outside"})

    def test_so_they_are_of_photographs(self):
        cones = Path(DATA) / "cones_half"
        if not cones.is_dir():
            self.skipTest(f"there is no {cones}")
        pair = [cones / "im2.png", cones / "im6.png", "--left-disparity", cones / "disp2.png",
                "--right-disparity", cones / "disp6.png", "--disparity-scale", "2"]
        page = self.folder / "cones.html"
        vantage("view", *pair, "-o", page)
        views = {("0.25", "0"): "between", ("-0.4", "0"): "outside"}
        if tests_all_cases():
            views |= {("0.5", "0"): "between", ("0", "0"): "between", ("1", "0"): "between",
                      ("0.5", "0.2"): "between"}
        self.expect_synthesized_views(page, pair, views)

    def test_maps_with_gaps_and_other_options(self):
        left, right = self.folder / "left.pgm", self.folder / "right.pgm"
        maps = [self.folder / "left-map.pgm", self.folder / "right-map.pgm"]
        width, height = 64, 40

        def texture(x, y):
            return int(128 + 60 * math.sin(x * 0.7 + y * 0.3) + 50 * math.cos(y * 0.9 - x * 0.2))

        def shape(x, y):  # a near square before a background that comes nearer to the right
            return 9 if 20 <= x < 38 and 12 <= y < 28 else 2 + x // 12

        def known(x, y):  # rows and a patch are not
            return y >= 3 and y != 20 and not (50 <= x < 55 and y < 20)

        def write(file, value):
            file.write_bytes(b"P5\n%d %d\n255\n" % (width, height) + bytes(
                value(x, y) for y in range(height) for x in range(width)))
        write(left, texture)
        write(right, lambda x, y: min(texture(x + shape(x, y), y) + 8, 255))
        for file in maps:
            write(file, lambda x, y: 16 * shape(x, y) if known(x, y) else 0)
        pair = [left, right, "--left-disparity", maps[0], "--right-disparity", maps[1],
                "--disparity-scale", "16"]
        # Mostly without the regression: so small a picture has not the same one everywhere.
        for name, options in {"interpolate": [],
                              "mirror": ["--gamma", "alpha"],
                              "spread": ["--gradient-limit", "4", "--no-intensity-matching"],
                              "none": ["--no-intensity-matching"]}.items():
            options += ["--holes", name]
            page = self.folder / f"{name}.html"
            vantage("view", *pair, *options, "-o", page)
            self.expect_synthesized_views(page, [*pair, *options], {
                ("0.5", "0"): "between", ("1.25", "0"): "outside", ("0.5", "-0.2"): "between"})

    def test_nothing_is_asked_of_the_network(self):
        def elsewhere(tab):
            return [url for url in tab.requests() if not url.startswith(("file:", "data:"))]
        tab = self.open()
        self.assertGreater(len(tab.requests()), 0)  # the file itself
        self.assertEqual(elsewhere(tab), [])
        # If somebody changes the page so that it tries, its own policy forbids it.
        for attempt in [f"fetch('{NO_SERVER}').catch(() => {{}})", f"new Image().src = '{NO_SERVER}'",
                        f"document.body.append(Object.assign(document.createElement('iframe'), "
                        f"{{src: '{NO_SERVER}'}}))"]:
            blocked = tab.evaluate("new Promise((resolve) => { addEventListener("
                                   "'securitypolicyviolation', (event) => resolve(event.blockedURI), "
                                   f"{{once: true}}); {attempt}; }})")
            self.assertTrue(blocked.startswith(NO_SERVER), blocked)
        # What a page without a policy asks for would have been seen.
        free = self.folder / "free.html"
        free.write_text(f"<!DOCTYPE html><img src='{NO_SERVER}/a.png'>", encoding="utf-8")
        tab = Tab(self.browser, free.as_uri())
        self.addCleanup(tab.close)
        self.assertEqual(elsewhere(tab), [f"{NO_SERVER}/a.png"])

    def test_the_address_says_where_and_what(self):
        for address in ["#x=0.25,y=0.1,mode=disparity", "?x=0.25&y=0.1&mode=disparity"]:
            tab = self.open(address)
            self.arrives_at(tab, 0.25, 0.1)
            self.assertEqual(tab.evaluate("document.getElementById('mode').value"), "disparity")
        # What is out of range or nonsense is brought into range or left alone.
        tab.evaluate("location.hash = 'x=99,y=zero,mode=upside-down'")
        self.arrives_at(tab, 1.5, 0.1)
        self.assertEqual(tab.complaints(), [])

    def test_mouse_keys_and_sliders_move_the_view(self):
        tab = self.open()
        box = tab.evaluate("(({width, height}) => ({width, height}))"
                           "(document.getElementById('canvas').getBoundingClientRect())")

        def mouse(kind, x, y, **more):
            tab.call("Input.dispatchMouseEvent", type=kind, x=box["width"] * x,
                     y=box["height"] * y, **more)
        mouse("mouseMoved", 0.25, 0.75)
        self.arrives_at(tab, 0.0, 0.1)
        for kind in ["mousePressed", "mouseReleased"]:  # holds the view
            mouse(kind, 0.25, 0.75, button="left", clickCount=1)
        mouse("mouseMoved", 0.5, 0.5)
        self.arrives_at(tab, 0.0, 0.1)
        tab.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowRight")
        self.arrives_at(tab, 0.05, 0.1)
        tab.evaluate("(() => { const x = document.getElementById('x'); x.value = 0.75;"
                     "x.dispatchEvent(new Event('input')); })()")
        self.arrives_at(tab, 0.75, 0.1)
        tab.call("Input.dispatchKeyEvent", type="keyDown", key=" ")
        self.assertEqual(tab.evaluate("document.getElementById('sway').ariaPressed"), "true")
        self.assertEqual(tab.complaints(), [])

    def test_every_mode_draws_something_else(self):
        tab = self.open("#x=0.25")
        modes = ["view", "disparity", "left", "right", "cloud"]
        drawn = {}
        for mode in modes:
            # In the frame in which the page draws, after it: the canvas still holds the picture.
            drawn[mode] = tab.evaluate(
                "new Promise((resolve) => { addEventListener('hashchange', () => "
                "requestAnimationFrame(() => resolve(document.getElementById('canvas').toDataURL())),"
                f"{{once: true}}); location.hash = 'x=0.25,mode={mode}'; }})")
            blank = tab.evaluate("(() => { const canvas = document.createElement('canvas');"
                                 "const shown = document.getElementById('canvas');"
                                 "[canvas.width, canvas.height] = [shown.width, shown.height];"
                                 "return canvas.toDataURL().length; })()")
            self.assertGreater(len(drawn[mode]), 3 * blank, mode)
        self.assertEqual(len(set(drawn.values())), len(modes))
        self.assertEqual(tab.complaints(), [])

    def cloud_pixels(self, tab, address):
        """RGBA of the canvas, row by row from the bottom, once it shows the cloud as addressed."""
        return base64.b64decode(tab.evaluate(
            "new Promise((resolve) => { addEventListener('hashchange', () => "
            "requestAnimationFrame(() => { const canvas = document.getElementById('canvas');"
            "const gl = canvas.getContext('webgl2');"
            "const bytes = new Uint8Array(4 * canvas.width * canvas.height);"
            "gl.bindFramebuffer(gl.FRAMEBUFFER, null);"
            "gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);"
            "let text = ''; bytes.forEach((byte) => { text += String.fromCharCode(byte); });"
            f"resolve(btoa(text)); }}), {{once: true}}); location.hash = 'mode=cloud,{address}'; }})"))

    def test_the_cloud_starts_as_the_photograph(self):
        tab = self.open("#mode=cloud")
        width, height = tab.evaluate("[document.getElementById('canvas').width,"
                                     "document.getElementById('canvas').height]")
        scale = min(width / SIZE["width"], height / SIZE["height"])
        pixels = self.cloud_pixels(tab, "yaw=0")
        _, _, photograph = self.rgb_of("left.png")
        near, shown = 0, 0
        for y in range(4, SIZE["height"] - 4, 3):
            for x in range(4, SIZE["width"] - 4, 3):
                column = int(width / 2 + (x - (SIZE["width"] - 1) / 2) * scale)
                row = int(height / 2 - (y - (SIZE["height"] - 1) / 2) * scale)
                at = 4 * (row * width + column)
                truth = photograph[3 * (y * SIZE["width"] + x):][:3]
                drawn = pixels[at:at + 3]
                shown += any(drawn)
                near += all(abs(a - b) <= 40 for a, b in zip(drawn, truth))
        self.assertGreater(near, 0.9 * shown)
        self.assertGreater(shown, 0.8 * (SIZE["width"] - 8) * (SIZE["height"] - 8) / 9)
        self.assertEqual(tab.complaints(), [])

    def test_the_cloud_follows_the_mouse(self):
        tab = self.open("#mode=cloud")
        orbit = ("(() => { const seen = {}; const turn = Orbit.prototype.turn;"
                 "Orbit.prototype.turn = function(...a) { turn.apply(this, a); window.seen = this; };"
                 "return true; })()")
        tab.evaluate(orbit)
        for kind, x, y, buttons in [("mousePressed", 100, 100, 1), ("mouseMoved", 150, 100, 1),
                                    ("mouseMoved", 150, 120, 1), ("mouseReleased", 150, 120, 0),
                                    ("mouseMoved", 250, 220, 0)]:
            tab.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left",
                     buttons=buttons, clickCount=1)
        yaw, pitch, distance = tab.evaluate("[seen.yaw, seen.pitch, seen.distance]")
        self.assertLess(yaw, -10)  # the near side moves with the mouse
        self.assertGreater(pitch, 4)
        self.assertEqual(distance, 1)
        tab.call("Input.dispatchMouseEvent", type="mouseWheel", x=100, y=100, deltaX=0, deltaY=-100)
        self.assertLess(tab.evaluate("new Promise((resolve) => setTimeout(() => "
                                     "resolve(seen.distance), 100))"), 0.9)
        tab.evaluate("document.getElementById('reset').click()")
        self.assertEqual(tab.evaluate("[seen.yaw, seen.pitch, seen.distance]"), [0, 0, 1])
        self.assertEqual(tab.complaints(), [])

    def test_graphics_that_go_away_may_come_back(self):
        tab = self.open("#x=0.25")
        events = tab.evaluate(
            "new Promise((resolve) => { const canvas = document.getElementById('canvas');"
            "const context = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');"
            "canvas.addEventListener('webglcontextlost', () => setTimeout(() => "
            "context.restoreContext()));"
            "canvas.addEventListener('webglcontextrestored', () => setTimeout(() => resolve(true)));"
            "context.loseContext(); })")
        self.assertTrue(events)
        tab.evaluate("location.hash = 'x=0.75'")
        self.arrives_at(tab, 0.75, 0)
        self.assertEqual(tab.evaluate("document.documentElement.dataset.status"), "ready")

    def test_a_browser_without_webgl_says_so(self):
        with Browser("--disable-3d-apis") as browser:
            tab = Tab(browser, self.page.as_uri())
            self.assertEqual(status_of(tab), "failed")
            self.assertIn("WebGL 2", tab.text("message"))


if __name__ == "__main__":
    VANTAGE, DATA = sys.argv[1:3]
    if reason := why_impossible():
        print(f"skipped: {reason}")
        sys.exit(EXIT_SKIPPED)
    unittest.main(argv=sys.argv[:1], verbosity=2)
