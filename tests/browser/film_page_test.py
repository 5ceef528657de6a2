"""The page that `vantage view` writes of a run's folder, in a headless Chromium.

usage: film_page_test.py VANTAGE

Exits with 77 where there is no Chromium, or one that cannot draw.
"""

import base64
import sys
import tempfile
import unittest
from pathlib import Path

import view_page_test
from headless_browser import Browser, Tab
from view_page_test import (EXIT_SKIPPED, LEAST_PSNR_DB, psnr_db, read_pnm, status_of, vantage,
                            why_impossible)

SIZE = {"width": 160, "height": 120, "frames": 8}
LOST_MAP, LOST_SCRIPT = 3, 4

# A headset whose eyes are 2·EYE_M apart and side by side on the canvas; it shows what it is given
# when asked, not by itself.
EYE_M = 0.03
FAKE_HEADSET = """
const eye = (x, right) => ({right, projectionMatrix: new Float32Array(
    [1.7, 0, 0, 0, 0, 1.7, 0, 0, 0, 0, -1, -1, 0, 0, -0.2, 0]),
  transform: {position: {x, y: 0, z: 0}, inverse: {matrix: new Float32Array(
    [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, 0, 0, 1])}}});
window.XRWebGLLayer = class {
  constructor() { this.framebuffer = null; }
  getViewport({right}) { return {x: right ? 150 : 0, y: 0, width: 150, height: 150}; }
};
class Session extends EventTarget {
  updateRenderState(state) { this.renderState = state; }
  async requestReferenceSpace() { return {}; }
  requestAnimationFrame(draw) { window.drawEyes = (time) => draw(time,
    {getViewerPose: () => ({views: [eye(-EYE_M, false), eye(EYE_M, true)]})}); }
}
Object.defineProperty(navigator, "xr", {value: {
  isSessionSupported: async (mode) => mode === "immersive-vr",
  requestSession: async () => (window.headset = new Session())}});
WebGL2RenderingContext.prototype.makeXRCompatible = async () => {};
""".replace("EYE_M", str(EYE_M))

# Counts pictures that are decoded and not freed.
COUNT_PICTURES = """
window.pictures = {open: 0, most: 0};
const decode = window.createImageBitmap;
window.createImageBitmap = async (...a) => {
  const bitmap = await decode(...a);
  pictures.most = Math.max(pictures.most, ++pictures.open);
  const close = bitmap.close.bind(bitmap);
  bitmap.close = () => { --pictures.open; close(); };
  return bitmap;
};
"""


class FilmPageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.film, cls.results = cls.folder / "film", cls.folder / "run"
        vantage("generate", "scene", "-o", cls.film,
                *(f"--{name}={value}" for name, value in SIZE.items()))
        vantage("run", "--left", cls.film / "left", "--right", cls.film / "right", "--disparities",
                "2:10", "--save", "disparity,right-disparity", "-o", cls.results)
        cls.exact = cls.results / "exact.html"
        vantage("view", cls.results, "-o", cls.exact, "--images", "png")
        cls.page = cls.folder / "film.html"
        (cls.results / "disparity" / f"{LOST_MAP:06}.pfm").unlink()
        vantage("view", cls.results, "-o", cls.page)
        (cls.folder / "film-frames" / f"{LOST_SCRIPT:06}.js").unlink()
        cls.browser = cls.enterClassContext(Browser())

    def open(self, page, address="", script=""):
        tab = Tab(self.browser, page.as_uri() + address, width=400, height=400, script=script)
        self.addCleanup(tab.close)
        self.assertEqual(status_of(tab), "ready", (tab.text("message"), tab.complaints()))
        return tab

    def shows_frame(self, tab, number):
        """Waits for it; returns what the page says of it at that moment: a film goes on."""
        return tab.evaluate(
            "new Promise((resolve) => { const look = () => {"
            " const message = document.getElementById('message');"
            f" if (document.getElementById('time-value').textContent === '{number}')"
            " { resolve(message.hidden ? '' : message.textContent); }"
            " else { setTimeout(look, 5); } }; look(); })")

    def test_views_of_a_frame_are_those_of_synth(self):
        frame = f"{5:06}"
        positions = {("0.5", "0"): "between", ("1.25", "0"): "outside", ("0.5", "0.2"): "between"}
        tab = self.open(self.exact, "#render=native,frame=5," +
                        ",".join(f"x={x},y={y}" for x, y in positions))
        for (x, y), where in positions.items():
            expected = self.folder / "synth.ppm"
            vantage("synth", self.film / "left" / f"{frame}.png", self.film / "right" / f"{frame}.png",
                    "--left-disparity", self.results / "disparity" / f"{frame}.pfm",
                    "--right-disparity", self.results / "right-disparity" / f"{frame}.pfm",
                    "--view", f"{x},{y}", "-o", expected)
            pixels = base64.b64decode(tab.evaluate(
                f"document.querySelector('pre.pixels[data-x=\"{x}\"][data-y=\"{y}\"]').textContent"))
            psnr = psnr_db(pixels, read_pnm(expected)[2])
            print(f"frame 5 at ({x}, {y}): {psnr:.1f} dB", file=sys.stderr)
            self.assertGreaterEqual(psnr, LEAST_PSNR_DB[where])
        self.assertEqual(tab.complaints(), [])

    def test_it_plays_steps_and_tells_of_missing_frames(self):
        tab = self.open(self.page)
        self.assertEqual(self.shows_frame(tab, 0), "")
        tab.evaluate("document.getElementById('forth').click()")
        self.assertEqual(self.shows_frame(tab, 1), "")
        tab.evaluate("document.getElementById('back').click();"
                     "document.getElementById('back').click()")
        self.assertEqual(self.shows_frame(tab, 7), "")  # round the end
        tab.evaluate(f"location.hash = 'frame={LOST_MAP}'")
        self.assertIn("not in the folder", self.shows_frame(tab, LOST_MAP))
        tab.evaluate("(() => { const time = document.getElementById('time');"
                     f"time.value = {LOST_SCRIPT}; time.dispatchEvent(new Event('input')); }})()")
        self.assertIn("cannot be loaded", self.shows_frame(tab, LOST_SCRIPT))
        tab.call("Input.dispatchKeyEvent", type="keyDown", key=" ")
        self.assertEqual(tab.text("play"), "Pause")
        self.assertEqual(self.shows_frame(tab, 6), "")
        self.assertEqual(self.shows_frame(tab, 2), "")
        missing = [text for text in tab.complaints() if "FILE_NOT_FOUND" not in text]
        self.assertEqual(missing, [])

    def test_few_frames_are_kept(self):
        kept = 3
        small = self.results / "small.html"
        bytes_of_frame = 16 * SIZE["width"] * SIZE["height"]
        small.write_text(self.exact.read_text(encoding="utf-8")
                         .replace("= 256 * 1024 * 1024;", f"= {kept * bytes_of_frame};"),
                         encoding="utf-8")
        tab = self.open(small, "#play=1", COUNT_PICTURES)
        for number in [4, 7, 1]:
            self.shows_frame(tab, number)
        tab.evaluate("document.getElementById('play').click()")
        open_pictures, most = tab.evaluate(
            "new Promise((resolve) => setTimeout(() => resolve([pictures.open, pictures.most]), 300))")
        self.assertEqual(open_pictures, 4 * kept)
        self.assertLessEqual(most, 4 * (kept + 1))  # while one is handed on

    def test_each_eye_of_a_headset_has_its_own_view(self):
        self.assertTrue(self.open(self.page).evaluate("document.getElementById('headset').hidden"))
        tab = self.open(self.exact, "#frame=5", FAKE_HEADSET)
        drawn, asked = tab.evaluate("""(async () => {
          const asked = [];
          const render = Renderer.prototype.render;
          Renderer.prototype.render = function(x, y) { asked.push([x, y]); render.call(this, x, y); };
          document.getElementById("headset").click();
          while (!window.drawEyes) { await new Promise((resolve) => setTimeout(resolve, 10)); }
          const gl = document.getElementById("canvas").getContext("webgl2");
          asked.length = 0;  // of the page itself
          drawEyes(performance.now());
          const eyes = [0, 150].map((left) => {
            const bytes = new Uint8Array(4 * 150 * 150);
            gl.readPixels(left, 0, 150, 150, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
            return [...bytes];
          });
          return [eyes, asked];
        })()""")
        (left_x, left_y), (right_x, right_y) = asked
        self.assertEqual((left_y, right_y), (0, 0))
        self.assertAlmostEqual((left_x + right_x) / 2, 0.5, places=6)
        self.assertGreater(right_x, left_x)
        self.assertLessEqual(right_x - left_x, 2 * EYE_M / 0.063 + 1e-6)
        # A screen in the middle, black around it, both eyes much alike and not the same.
        for eye in drawn:
            self.assertEqual(eye[:3], [0, 0, 0])
            self.assertGreater(sum(eye[4 * (75 * 150 + 75):][:3]), 0)
        self.assertNotEqual(drawn[0], drawn[1])
        self.assertGreater(psnr_db(drawn[0], drawn[1]), 12)
        tab.evaluate("headset.dispatchEvent(new Event('end'))")
        self.assertEqual(tab.complaints(), [])


if __name__ == "__main__":
    view_page_test.VANTAGE = sys.argv[1]
    if reason := why_impossible():
        print(f"skipped: {reason}")
        sys.exit(EXIT_SKIPPED)
    unittest.main(argv=sys.argv[:1], verbosity=2)
