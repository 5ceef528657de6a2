#!/usr/bin/env python3
"""`vantage-asp`, called as Ames Stereo Pipeline calls matchers: float TIFF files of tiles whose
pixels without data are NaN, in a folder of their own. usage: asp_test.py VANTAGE"""

import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent.parent / "depths"))
from plain_readers import read_pfm, read_png  # noqa: E402
from plain_tiff import read_tiff, write_tiff  # noqa: E402

WIDTH, HEIGHT = 260, 180
SHIFT_PX = 9    # of the right image: disparities then have both signs
HOLE_LEFT = (100, 140, 50, 90)     # columns, rows
HOLE_RIGHT = (40, 70, 100, 150)
NAN = math.nan


def within(x, y, hole):
    return hole[0] <= x < hole[1] and hole[2] <= y < hole[3]


class Asp(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        os.chdir(cls.folder.name)
        subprocess.run([VANTAGE, "generate", "scene", "-o", "scene", "--width", str(WIDTH),
                        "--height", str(HEIGHT), "--near", "20", "--quiet"], check=True)
        # Values of no picture: radiances.
        left, right = ([[200 + 0.37 * pixel[1] for pixel in row]
                        for row in read_png(f"scene/{side}.png")] for side in ("left", "right"))
        cls.truth = [[SHIFT_PX - d for d in row] for row in read_pfm("scene/left-disparity.pfm")]
        hidden = read_png("scene/left-occluded.png")
        cls.visible = [[hidden[y][x][0] == 0 and 0 <= x + cls.truth[y][x] < WIDTH
                        for x in range(WIDTH)] for y in range(HEIGHT)]
        # The right image moves to the right; what enters has no data.
        right = [[NAN] * SHIFT_PX + row[:-SHIFT_PX] for row in right]
        cls.whole = left, right
        cls.holed = ([[NAN if within(x, y, HOLE_LEFT) else row[x] for x in range(WIDTH)]
                      for y, row in enumerate(left)],
                     [[NAN if within(x, y, HOLE_RIGHT) else row[x] for x in range(WIDTH)]
                      for y, row in enumerate(right)])
        Path("plugins/bin").mkdir(parents=True)
        os.symlink(VANTAGE, "plugins/bin/vantage-asp")

    @classmethod
    def tearDownClass(cls):
        os.chdir("/")
        cls.folder.cleanup()

    def call(self, images, *options, output="out.tif"):
        """As the pipeline does: <program> <options> left.tif right.tif output.tif"""
        for name, image in zip(("left.tif", "right.tif"), images):
            write_tiff(name, image)
        Path(output).unlink(missing_ok=True)
        return subprocess.run(["plugins/bin/vantage-asp", *options, "left.tif", "right.tif", output],
                              capture_output=True, text=True)

    def map_of(self, images, *options):
        done = self.call(images, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = read_tiff("out.tif")
        self.assertEqual((len(found[0]), len(found)), (WIDTH, HEIGHT))
        return found

    def shares(self, found, is_judged):
        """Shares of the judged visible pixels that have a disparity, and of those a right one."""
        judged = [(found[y][x], self.truth[y][x]) for y in range(HEIGHT) for x in range(WIDTH)
                  if self.visible[y][x] and is_judged(x, y)]
        known = [(d, truth) for d, truth in judged if not math.isnan(d)]
        self.assertGreater(len(known), 100)
        return len(known) / len(judged), sum(abs(d - t) <= 1 for d, t in known) / len(known)

    def test_gaps_stay_gaps_and_spread_nowhere(self):
        found = self.map_of(self.holed)
        shown = 0
        for y in range(HEIGHT):
            for x in range(WIDTH):
                d = found[y][x]
                if within(x, y, HOLE_LEFT):
                    self.assertTrue(math.isnan(d), (x, y))
                elif not math.isnan(d):
                    at = round(x + d)
                    self.assertTrue(0 <= at < WIDTH and not math.isnan(self.holed[1][y][at]), (x, y))
                    shown += 1
        self.assertGreater(shown, 0.7 * WIDTH * HEIGHT)

        def has_data(x, y):
            at = min(max(round(x + self.truth[y][x]), 0), WIDTH - 1)
            return not math.isnan(self.holed[0][y][x]) and not math.isnan(self.holed[1][y][at])

        def is_beside(x, y):
            return has_data(x, y) and any(
                within(x + dx, y + dy, HOLE_LEFT)
                for dx, dy in ((4, 0), (-4, 0), (0, 4), (0, -4)))
        whole = self.map_of(self.whole)
        known, correct = self.shares(found, has_data)
        known_of_whole, correct_of_whole = self.shares(whole, has_data)
        self.assertGreater(known, known_of_whole - 0.02)
        self.assertGreater(correct, correct_of_whole - 0.01)
        self.assertGreater(correct_of_whole, 0.97)
        known_beside, correct_beside = self.shares(found, is_beside)
        self.assertGreater(known_beside, 0.8)
        self.assertGreater(correct_beside, 0.9)

    def test_both_signs_are_found_and_can_be_given(self):
        found = self.map_of(self.whole)
        values = [d for row in found for d in row if not math.isnan(d)]
        self.assertLess(min(values), -5)
        self.assertGreater(max(values), 4)
        given = self.map_of(self.whole, "--disp-min", "-12", "--disp-max", "9", "--preset", "balanced")
        self.assertGreater(self.shares(given, lambda x, y: True)[1], 0.97)
        left = self.map_of(self.whole, "--disp-min=-9", "--disp-max=12", "--preset", "balanced",
                           "--sign", "left-minus-right")
        for row, other in zip(given, left):
            for d, e in zip(row, other):
                self.assertTrue(d == -e or (math.isnan(d) and math.isnan(e)))

    def test_tiles_without_anything_to_match_are_gaps(self):
        empty = [[NAN] * WIDTH for _ in range(HEIGHT)]
        for images in ((empty, self.whole[1]), (self.whole[0], empty)):
            done = self.call(images)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("an image has no data", done.stderr)
            self.assertTrue(all(math.isnan(d) for row in read_tiff("out.tif") for d in row))

    def test_mistakes_are_one_line_and_leave_nothing(self):
        cases = [((), [row[:-1] for row in self.whole[1]], "out.tif", "expected equal sizes"),
                 (("--disp-min", "3"), self.whole[1], "out.tif", "expected both"),
                 (("--disp-min=3", "--disp-max=2"), self.whole[1], "out.tif", "smaller first"),
                 (("--disp-min=-2147483648", "--disp-max=2"), self.whole[1], "out.tif",
                  "expected numbers within"),
                 ((), self.whole[1], "out.txt", "out.txt"),
                 ((), self.whole[1], "out.png", "PNG holds no gaps"),
                 ((), self.whole[1], "nowhere/out.tif", "nowhere")]
        for options, right, output, message in cases:
            done = self.call((self.whole[0], right), *options, output=output)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(message, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            self.assertFalse(Path(output).exists())
        done = subprocess.run(["plugins/bin/vantage-asp", "left.tif", "right.tif", "./left.tif"],
                              capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(len(read_tiff("left.tif")), HEIGHT)


if __name__ == "__main__":
    VANTAGE = str(Path(sys.argv.pop(1)).resolve())
    unittest.main()
