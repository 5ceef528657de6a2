#!/usr/bin/env python3
"""Power cuts: whatever one leaves of a run, a merge or a scene (`disk_states`), the same command
with --resume ends with the bytes of an undisturbed one, and `verify` finds them so. Where a run was
to be replaced, it may also be there as it was.

A sample of the cuts; with VANTAGE_TEST_ALL all of them, and how many there were.
usage: power_cut_test.py VANTAGE IO_RECORD"""

import os
import random
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from disk_states import Disk, put, read_record

EVERYTHING = os.environ.get("VANTAGE_TEST_ALL", "0") not in ("", "0")
SEED = int(os.environ.get("VANTAGE_TEST_SEED", "1"))
SAMPLE = 12   # cuts of a test
MEMORY = "/dev/shm"  # flushes cost nothing there


def call(*words, record=None, may_fail=False):
    environment = dict(os.environ)
    if record is not None:
        environment |= {"LD_PRELOAD": IO_RECORD, "IO_RECORD_FOLDER": str(record[0]) + "/",
                        "IO_RECORD_LOG": str(record[1])}
    result = subprocess.run([VANTAGE, *map(str, words)], env=environment, capture_output=True)
    if result.returncode != 0 and not may_fail:
        raise AssertionError(f"{' '.join(map(str, words))}: {result.returncode} "
                             f"{result.stderr.decode()}")
    return result


def results(folder):
    """Names and bytes of all that is not of the journal."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in Path(folder).rglob("*")
            if path.is_file() and path.relative_to(folder).parts[0] not in (".vantage", ".lock")}


class PowerCut(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory(dir=MEMORY if os.path.isdir(MEMORY) else None)
        self.folder = Path(self.holder.name)
        self.disk = self.folder / "disk"
        self.out = self.disk / "out"
        self.disk.mkdir()
        call("generate", "scene", "-o", self.folder / "film", "--frames", "6", "--width", "64",
             "--height", "48", "--far", "1", "--near", "6", "--quiet")

    def tearDown(self):
        self.holder.cleanup()

    def run_words(self, *more):
        return ["run", "--left", self.folder / "film/left", "--right", self.folder / "film/right",
                "-o", self.out, "--disparities=0:9", "--method", "ssd", "--threads", "2", "--quiet",
                *more]

    def check(self, command, again, verifies=True):
        """`again`: the command that finishes what a cut has left."""
        before = Disk(str(self.disk))
        begun = results(self.out) if self.out.exists() else {}
        log = self.folder / f"log of {command[0]}"
        call(*command, record=(self.disk, log))
        expected = results(self.out)
        states = {}
        for operation in read_record(log):
            before.apply(*operation)
            for name, state in before.cuts(SEED):
                states.setdefault(tuple(state.items()), (name, state))
        whole = before.without_cut()
        self.assertEqual({name: whole.get("out/" + name) for name in expected}, expected,
                         "the record misses calls")
        chosen = list(states.values())
        if not EVERYTHING:
            chosen = random.Random(SEED).sample(chosen, min(SAMPLE, len(chosen)))
        failures = []
        for name, state in [*chosen, ("no cut", whole)]:  # the last one for what comes next
            if problem := self.problem_of(state, begun, expected, again, verifies):
                failures.append(f"{name}: {problem}")
        print(f"{self.id()}: {before.moment} calls, {len(states)} states, {len(chosen) + 1} taken, "
              f"{len(failures)} fail", file=sys.stderr)
        self.assertEqual(failures, [], f"VANTAGE_TEST_SEED={SEED}")

    def problem_of(self, state, begun, expected, again, verifies):
        shutil.rmtree(self.disk)
        self.disk.mkdir()
        put(state, self.disk)
        result = call(*again, may_fail=True)
        error = result.stderr.decode()
        if result.returncode != 0:
            if "holds a different run" not in error or error.count("\n") != 1:
                return f"{result.returncode} {error}"
            expected = begun
        found = results(self.out)
        if found != expected:
            return "other: " + ", ".join(sorted(
                name for name in found.keys() | expected.keys()
                if found.get(name) != expected.get(name)))
        if verifies:
            result = call("verify", self.out, "--quiet", may_fail=True)
            if result.returncode != 0 or result.stderr:
                return f"verify: {result.returncode} {result.stderr.decode()}"
        return ""

    def test_maps_as_files(self):
        words = self.run_words("--save", "disparity,preview", "--chunk-frames", "3",
                               "--temporal-prior", "1")
        self.check(words, words + ["--resume"])

    def test_videos_and_reports(self):
        words = self.run_words("--save", "disparity,views,depth-video,comfort", "--view", "0.5",
                               "--video", "views", "--chunk-frames", "3")
        self.check(words, words + ["--resume"])

    def test_second_shard_and_merge(self):
        words = self.run_words("--save", "disparity,views", "--view", "0.5", "--video", "views",
                               "--chunk-frames", "3")
        call(*words, "--shard", "1/2")
        second = words + ["--shard", "2/2"]
        self.check(second, second + ["--resume"])
        self.check(["merge", self.out, "--quiet"], ["merge", self.out, "--quiet"])

    def test_overwriting(self):
        call(*self.run_words("--save", "disparity,preview"))
        words = self.run_words("--save", "disparity,preview", "--window", "5")
        self.check(words + ["--overwrite"], words + ["--resume"])

    def test_scene(self):
        images = self.folder / "images"
        images.mkdir()
        for i, name in enumerate(("left/000000.png", "right/000000.png", "right/000003.png")):
            shutil.copy(self.folder / "film" / name, images / f"{i}.png")
        words = ["scene", "build", "--images", images, "-o", self.out, "--disparities=0:9",
                 "--no-rectification-check", "--copy-images", "--threads", "2", "--quiet"]
        self.check(words, words, verifies=False)


if __name__ == "__main__":
    VANTAGE, IO_RECORD = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
