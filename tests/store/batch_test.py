#!/usr/bin/env python3
"""Batches whose workers are killed, in a folder and in an object store that is busy, cuts and loses
answers: every item once, with the bytes that one undisturbed process makes. usage: batch_test.py VANTAGE

With VANTAGE_TEST_ALL: 500 small films and 3 large ones, 8 workers (some minutes)."""

import binascii
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from object_server import ObjectServer

EVERYTHING = os.environ.get("VANTAGE_TEST_ALL", "0") not in ("", "0")
FILMS, LARGE_FRAMES, PAIRS, WORKERS, KILLS = (500, 300, 100, 8, 60) if EVERYTHING else (4, 12, 6, 3, 6)
OPTIONS = ["--preset", "realtime", "--save", "disparity,preview", "--format", "png", "--no-tuning",
           "--chunk-frames", "4", "--threads", "1"]
QUALITY = ["quality" if word == "realtime" else word for word in OPTIONS]
BATCH = [*OPTIONS, "--job-time", "1s", "--lease", "3s", "--quiet"]
VANTAGE = None


def run(*words, **settings):
    return subprocess.run([VANTAGE, *map(str, words)], capture_output=True, text=True, timeout=600,
                          **settings)


def files_below(folder):
    """{name: bytes} of the results."""
    return {name: file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()
            and ".vantage" not in (name := file.relative_to(folder).as_posix())
            and name != "items.jsonl"}


class Batches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp())
        made = run("generate", "scene", "-o", cls.folder / "clip", "--frames", 12, "--width", 64, "--height",
                   48)
        assert made.returncode == 0, made.stderr
        clip = cls.folder / "clip"
        for side in ("left", "right"):
            (cls.folder / "long" / side).mkdir(parents=True)
            frames = sorted((clip / side).glob("*.png"))
            for number in range(LARGE_FRAMES):
                shutil.copy(frames[number % len(frames)], cls.folder / "long" / side / f"{number:06}.png")
        lines = ["output,left,right,frames,disparities,video"]
        lines += [f"films/{n},clip/left,clip/right,{n % 9}-{n % 9 + 2},0:{9 + n % 3},preview"
                  for n in range(FILMS)]
        lines += [f"large/{n},long/left,long/right,,0:9,{'preview' if n == 1 else ''}" for n in range(3)]
        lines += [f"pairs/{n},clip/left/{n % 12:06}.png,clip/right/{n % 12:06}.png,,,"
                  for n in range(PAIRS)]
        cls.manifest = cls.folder / "manifest.csv"
        cls.manifest.write_text("\n".join(lines) + "\n")
        cls.items = len(lines) - 1
        alone = run("batch", cls.manifest, "-o", cls.folder / "alone", *OPTIONS, "--quiet")
        assert alone.returncode == 0, alone.stderr
        cls.expected = files_below(cls.folder / "alone")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def start(self, manifest, output, environment):
        return subprocess.Popen([VANTAGE, "batch", manifest, "-o", output, *BATCH, *self.more, "--worker"],
                                env={**os.environ, **environment}, stderr=subprocess.PIPE, text=True)

    def disturb(self, manifest, output, environment, meanwhile=lambda: None):
        """Kills workers at random moments, then lets the others end."""
        chosen = random.Random(int(os.environ.get("VANTAGE_TEST_SEED", "1")))
        workers = [self.start(manifest, output, environment) for _ in range(WORKERS)]
        for _ in range(KILLS):
            time.sleep(chosen.uniform(0.05, 0.5))
            meanwhile()
            victim = chosen.randrange(WORKERS)
            workers[victim].send_signal(signal.SIGKILL if chosen.random() < 0.7 else signal.SIGTERM)
            workers[victim].communicate()
            workers[victim] = self.start(manifest, output, environment)
        for worker in workers:
            err = worker.communicate(timeout=1200)[1]
            self.assertEqual(worker.returncode, 0, err)

    def check_items(self, text, content):
        items = [json.loads(line) for line in text.splitlines()]
        self.assertEqual(len(items), self.items)
        self.assertEqual({item["output"] for item in items},
                         {line.split(",")[0] for line in self.manifest.read_text().splitlines()[1:]})
        for item in items:
            self.assertEqual(item["status"], "done", item)
            for file in item.get("files", []):
                self.assertEqual(f"{binascii.crc32(content[file['name']]):08x}", file["crc32"])

    def compare(self, made):
        self.assertEqual(made.keys(), self.expected.keys())
        different = [name for name, content in made.items() if content != self.expected[name]]
        self.assertEqual(different, [])

    def test_a_folder(self):
        self.more = []
        output = self.folder / "shared"
        self.disturb(self.manifest, output, {})
        self.check_items((output / "items.jsonl").read_text(), files_below(output))
        self.compare(files_below(output))
        for n in range(3):
            self.assertEqual(run("verify", output / f"large/{n}").returncode, 0)

    def test_an_object_store(self):
        self.more = ["--keep-every", "1s", "--scratch", str(self.folder)]
        with ObjectServer(page_keys=1000) as server:
            server.add_folder(self.folder / "clip", "clip/")
            server.add_folder(self.folder / "long", "long/")
            server.put("manifest.csv", self.manifest.read_bytes())
            server.faults.busy_share = 0.05
            server.faults.cut_share = 0.02

            def lose_an_answer():
                server.faults.lost_answers = 1

            self.disturb("s3://data/manifest.csv", "s3://data/out", server.environment(), lose_an_answer)
            made = {key.removeprefix("out/"): one for key, one in server.buckets["data"].items()
                    if key.startswith("out/")}
            self.check_items(made.pop("items.jsonl").content.decode(),
                             {name: one.content for name, one in made.items()})
            self.compare({name: one.content for name, one in made.items() if ".vantage" not in name})
            self.assertEqual([name for name, one in made.items() if one.checksum is None], [])
            left = [name for name in made if name.startswith("large/") and "/segments/" in name]
            self.assertEqual(left, [])
            print(f"{len(server.requests)} requests for {self.items} items", file=sys.stderr)

    def test_an_input_that_changes_is_an_error_of_its_item(self):
        with ObjectServer(page_keys=1000) as server:
            server.add_folder(self.folder / "clip", "clip/")
            server.put("manifest.csv", b"output,left,right\nfilm,clip/left,clip/right\n")
            changed = "clip/left/000005.png"
            server.faults.replace_after = ("clip/left/000001.png", 1, changed,
                                           server.buckets["data"]["clip/left/000000.png"].content)
            ended = run("batch", "s3://data/manifest.csv", "-o", "s3://data/out", *OPTIONS, "--attempts", 1,
                        env={**os.environ, **server.environment()})
            self.assertEqual(ended.returncode, 3, ended.stderr)
            self.assertIn("000005.png", ended.stderr)
            self.assertIn("has changed", ended.stderr)

    def test_parts_of_a_film_keep_what_others_made(self):
        frames = sorted((self.folder / "clip" / "left").glob("*.png"))
        with ObjectServer(page_keys=1000) as server:
            for side in ("left", "right"):
                for number in range(400):
                    frame = self.folder / "clip" / side / frames[number % len(frames)].name
                    server.put(f"many/{side}/{number:06}.png", frame.read_bytes())
            server.put("manifest.csv", b"output,left,right,video,disparities\n"
                       b"film,many/left,many/right,preview,0:9\n")
            ended = run("batch", "s3://data/manifest.csv", "-o", "s3://data/out", *QUALITY, "--job-time", 1,
                        env={**os.environ, **server.environment()})
            self.assertEqual(ended.returncode, 0, ended.stderr)
            if "out/.vantage/batch/done/merge-000000.json" not in server.buckets["data"]:
                self.skipTest("this machine is too fast for the film to be divided")
            asked = [(method, path) for method, path, _ in server.requests]
            joining = asked.index(("PUT", "/data/out/.vantage/batch/leases/merge-000000/000001"))
            chunks = [(at > joining, method) for at, (method, path) in enumerate(asked)
                      if "/segments/preview/" in path and method in ("PUT", "DELETE")]
            self.assertEqual(chunks, [(False, "PUT")] * 100 + [(True, "DELETE")] * 100)
            ended = run("batch", self.manifest, "-o", "s3://data/out", "--worker",
                        env={**os.environ, **server.environment()})
            self.assertIn("of another manifest", ended.stderr)

    def test_an_object_of_others_stays(self):
        with ObjectServer(page_keys=1000) as server:
            server.add_folder(self.folder / "clip", "clip/")
            server.put("manifest.csv", b"output,left,right\npair,clip/left/000000.png,clip/right/000000.png\n"
                       b"film,clip/left,clip/right\n")
            mine = ("out/pair/disparity.png", "out/film/disparity/000002.png")
            for key in mine:
                server.put(key, b"mine")
            ended = run("batch", "s3://data/manifest.csv", "-o", "s3://data/out", *OPTIONS,
                        env={**os.environ, **server.environment()})
            self.assertEqual(ended.returncode, 3, ended.stderr)
            self.assertEqual(ended.stderr.count("did not make it"), 2, ended.stderr)
            self.assertEqual([server.buckets["data"][key].content for key in mine], [b"mine"] * 2)

    def test_nothing_is_computed_without_keys_or_right(self):
        with ObjectServer() as server:
            server.put("manifest.csv", b"output,left,right\nfilm,clip/left,clip/right\n")
            manifest = self.folder / "small.csv"
            manifest.write_text("output,left,right\nfilm,clip/left,clip/right\n")
            for changes, says in (({"AWS_SECRET_ACCESS_KEY": "", "AWS_ACCESS_KEY_ID": ""}, "keys"),
                                  ({"AWS_REGION": "elsewhere"}, "region")):
                ended = run("batch", manifest, "-o", "s3://data/out", *OPTIONS,
                            env={**os.environ, **server.environment(), **changes})
                self.assertEqual(ended.returncode, 1, ended.stderr)
                self.assertEqual(len(ended.stderr.splitlines()), 1, ended.stderr)
                self.assertIn(says, ended.stderr)
            self.assertFalse([key for key in server.buckets["data"] if key.startswith("out/")])


if __name__ == "__main__":
    VANTAGE = str(Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=2)
