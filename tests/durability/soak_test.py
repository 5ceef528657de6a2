#!/usr/bin/env python3
"""Long runs over damaged input: small frames, one in a hundred damaged. Resident memory, open files
and threads are the same in the first and the last fifth of the frames.

1,000 frames; with VANTAGE_TEST_ALL 5,000, and from videos to videos too. usage: soak_test.py VANTAGE
"""

import os
import random
import statistics
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

EVERYTHING = os.environ.get("VANTAGE_TEST_ALL", "0") not in ("", "0")
FRAMES = 5000 if EVERYTHING else 1000
DAMAGED_EVERY = 100
MEMORY = "/dev/shm"  # flushes cost nothing there
MEMORY_GROWTH = 1.05


class Soak(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory(dir=MEMORY if os.path.isdir(MEMORY) else None)
        self.folder = Path(self.holder.name)
        film = self.folder / "film"
        subprocess.run([VANTAGE, "generate", "scene", "-o", film, "--frames", "20", "--width", "64",
                        "--height", "48", "--near", "6", "--quiet"], check=True)
        (self.folder / "bad.png").write_bytes((film / "right/000000.png").read_bytes()[:500])
        for side in ("left", "right"):
            (self.folder / side).mkdir()
            for frame in range(FRAMES):
                bad = side == "right" and frame % DAMAGED_EVERY == 50
                os.link(self.folder / "bad.png" if bad else film / side / f"{frame % 20:06}.png",
                        self.folder / side / f"{frame:06}.png")

    def tearDown(self):
        self.holder.cleanup()

    def check(self, left, right, *options):
        """Runs, and returns the exit code."""
        words = [VANTAGE, "run", "--left", left, "--right", right, "-o", self.folder / "out",
                 "--disparities=0:9", "--threads", "2", "--keep-going", "--quiet", *options]
        process = subprocess.Popen(words, stderr=subprocess.PIPE)
        samples = []  # (frame, resident KiB, open files, threads)
        while process.poll() is None:
            try:
                status = dict(line.split(":", 1) for line in
                              Path(f"/proc/{process.pid}/status").read_text().splitlines())
                files = len(os.listdir(f"/proc/{process.pid}/fd"))
                journal = (self.folder / "out/.vantage/frames-all.jsonl").read_bytes()
                samples.append((journal.count(b"\n"), int(status["VmRSS"].split()[0]), files,
                                int(status["Threads"])))
            except (FileNotFoundError, KeyError, ProcessLookupError):
                pass  # not yet there, or gone
            try:
                process.wait(0.02)
            except subprocess.TimeoutExpired:
                pass
        error = process.stderr.read().decode()
        process.stderr.close()
        self.assertIn(process.returncode, (0, 3), error)
        lines = samples[-1][0]
        first = [sample for sample in samples if lines / 50 < sample[0] < lines / 5]
        last = [sample for sample in samples if sample[0] > lines * 4 / 5]
        self.assertGreater(min(len(first), len(last)), 3, "too few samples")
        figures = []
        for column, name in enumerate(("resident KiB", "open files", "threads"), 1):
            before, after = (statistics.median(sample[column] for sample in part)
                             for part in (first, last))
            figures.append(f"{name} {before:.0f} then {after:.0f}")
            self.assertLessEqual(after, before * MEMORY_GROWTH if column == 1 else before, figures)
        print(f"{self.id()}: {lines} lines, {len(samples)} samples: {', '.join(figures)}",
              file=sys.stderr)
        return process.returncode

    def test_maps_of_files(self):
        """The rows and the noise are looked at, as by default."""
        self.assertEqual(self.check(self.folder / "left", self.folder / "right", "--method", "ssd",
                                    "--save", "disparity"), 3)
        self.assertEqual(len(list((self.folder / "out/disparity").iterdir())),
                         FRAMES - FRAMES // DAMAGED_EVERY)

    @unittest.skipUnless(EVERYTHING, "long")
    def test_videos_of_videos(self):
        subprocess.run([VANTAGE, "run", "--left", self.folder / "left", "--right",
                        self.folder / "left", "-o", self.folder / "input", "--disparities=0:1",
                        "--method", "ssd", "--save", "views", "--video", "views", "--view", "0",
                        "--view", "0.5", "--no-rectification-check", "--quiet"], check=True)
        left, right = (self.folder / "input/views" / name for name in ("0.mp4", "0.5.mp4"))
        damaged = bytearray(right.read_bytes())
        chance = random.Random(1)
        for _ in range(FRAMES // DAMAGED_EVERY):
            at = chance.randrange(len(damaged) // 2, len(damaged) - 20)  # no table is there
            damaged[at:at + 16] = chance.randbytes(16)
        right.write_bytes(damaged)
        self.check(left, right, "--save", "views,preview", "--video", "views,preview", "--view",
                   "0.5")


if __name__ == "__main__":
    VANTAGE = sys.argv[1]
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
