#!/usr/bin/env python3
"""Inputs from and outputs to an object store: the bytes are those of local files, also where the store
is busy, cuts or is slow; what goes wrong is one line. usage: store_test.py VANTAGE"""

import contextlib
import http.server
import json
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

from object_server import KEY_ID, REGION, SECRET, ObjectServer

EVERYTHING = os.environ.get("VANTAGE_TEST_ALL", "0") not in ("", "0")
WIDTH, HEIGHT, FRAMES = 64, 48, 6
MATCH = ["--disparities=0:9", "--method", "ssd", "--threads", "2", "--quiet"]
MIB = 1 << 20


def box(kind, content):
    return struct.pack(">I4s", 8 + len(content), kind) + content


def with_index_at_end(film):
    """An MP4 whose index comes before its frames, with the index behind them."""
    boxes, at = [], 0
    while at < len(film):
        size = struct.unpack(">I", film[at:at + 4])[0]
        boxes.append((film[at + 4:at + 8], film[at:at + size]))
        at += size
    index = bytearray(next(content for kind, content in boxes if kind == b"moov"))
    at = index.find(b"stco")
    while at >= 0:
        for place in range(at + 12, at + 12 + 4 * struct.unpack(">I", index[at + 8:at + 12])[0], 4):
            offset = struct.unpack(">I", index[place:place + 4])[0]
            index[place:place + 4] = struct.pack(">I", offset - len(index))
        at = index.find(b"stco", at + 1)
    return b"".join(content for kind, content in boxes if kind != b"moov") + bytes(index)


def avi_with_sound(frames, width, height, rate):
    """Grey raw pictures, each with its share of PCM sound."""
    def chunk(name, content):
        return name + struct.pack("<I", len(content)) + content + b"\0" * (len(content) % 2)

    def listed(name, content):
        return chunk(b"LIST", name + content)

    def stream(kind, codec, scale, per, length, size, form):
        header = struct.pack("<4s4sIHHIIIIIIII4H", kind, codec, 0, 0, 0, 0, scale, per, 0, length,
                             1 << 16, 0xFFFFFFFF, size, 0, 0, width, height)
        return listed(b"strl", chunk(b"strh", header) + chunk(b"strf", form))

    count, hertz = len(frames), 8000
    share = hertz // rate
    main = struct.pack("<14I", 1000000 // rate, 0, 0, 0x110, count, 0, 2, 1 << 16, width, height,
                       0, 0, 0, 0)
    picture = struct.pack("<IiiHH4sIiiII", 40, width, height, 1, 24, b"\0\0\0\0", width * height * 3,
                          0, 0, 0, 0)
    sound = struct.pack("<HHIIHH", 1, 1, hertz, 2 * hertz, 2, 16)
    header = listed(b"hdrl", chunk(b"avih", main) +
                    stream(b"vids", b"DIB ", 1, rate, count, 0, picture) +
                    stream(b"auds", b"\0\0\0\0", 1, hertz, count * share, 2, sound))
    body = b"".join(
        chunk(b"00db", bytes(value for value in frame for _ in range(3))) +
        chunk(b"01wb", b"".join(struct.pack("<h", (i * 997) % 20000 - 10000) for i in range(share)))
        for frame in frames)
    return chunk(b"RIFF", b"AVI " + header + listed(b"movi", body))


def y4m(width, height, frames):
    """Large enough for several blocks; each frame is another grey ramp."""
    ramp = bytes(range(256)) * (width * height // 256 + 8)
    body = b"".join(b"FRAME\n" + ramp[7 * i:7 * i + width * height] for i in range(frames))
    return b"YUV4MPEG2 W%d H%d F25:1 Cmono\n" % (width, height) + body


def all_bytes(folder):
    """Content of the results in a folder; journals and reports name their inputs."""
    return {file.relative_to(folder).as_posix(): file.read_bytes()
            for file in sorted(Path(folder).rglob("*"))
            if file.is_file() and ".vantage" not in file.parts}


class StoreTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.holder.name)
        os.chdir(cls.folder)
        cls.local("generate", "scene", "-o", "scene", "--frames", FRAMES, "--width", WIDTH,
                  "--height", HEIGHT, "--near", 6, "--quiet")
        made = Path("made")
        cls.local("run", "--left", "scene/left", "--right", "scene/right", "-o", made, *MATCH,
                  "--save", "views,depth-video", "--video", "views", "--view", "0")
        data = Path("data")
        for side in ("left", "right"):
            (data / side).mkdir(parents=True)
            for frame in range(FRAMES):
                (data / side / f"{frame:06}.png").write_bytes(
                    Path(f"scene/{side}/{frame:06}.png").read_bytes())
        (data / "odd").mkdir()
        (data / "odd/a b+é&=%41.png").write_bytes((data / "left/000000.png").read_bytes())
        (data / "match.toml").write_text("disparities = '0:9'\nmethod = 'ssd'\n")
        (data / "calib.txt").write_text(
            "cam0=[60 0 32; 0 60 24; 0 0 1]\ncam1=[60 0 32; 0 60 24; 0 0 1]\ndoffs=0\n"
            f"baseline=100\nwidth={WIDTH}\nheight={HEIGHT}\n")
        (data / "lists").mkdir()
        (data / "lists/pairs.csv").write_text("".join(
            f"../left/{i:06}.png,../right/{i:06}.png\n" for i in (0, 2)))
        film = next(made.rglob("*.mp4")).read_bytes()
        (data / "front.mp4").write_bytes(film)
        (data / "end.mp4").write_bytes(with_index_at_end(film))
        (data / "film.mkv").write_bytes(next(made.rglob("*.mkv")).read_bytes())
        greys = [bytes((x * 5 + y * 3 + 11 * i) % 256 for y in range(48) for x in range(64))
                 for i in range(10)]
        (data / "sound.avi").write_bytes(avi_with_sound(greys, 64, 48, 10))
        (data / "large.y4m").write_bytes(y4m(640, 480, 70))
        cls.data = data

    @classmethod
    def tearDownClass(cls):
        os.chdir("/")
        cls.holder.cleanup()

    def setUp(self):
        self.server = ObjectServer()
        self.addCleanup(self.server.close)
        self.server.add_folder(self.data)
        self.out = tempfile.TemporaryDirectory(dir=self.folder)
        self.addCleanup(self.out.cleanup)

    @staticmethod
    def environment(variables):
        kept = {name: value for name, value in os.environ.items()
                if not name.startswith("AWS_") and not name.lower().endswith("_proxy")}
        return {**kept, "AWS_EC2_METADATA_DISABLED": "true", "HOME": "/nonexistent", **variables}

    @classmethod
    def local(cls, *words):
        done = subprocess.run([VANTAGE, *map(str, words)], capture_output=True, text=True)
        assert done.returncode == 0, f"{words}: {done.stderr}"
        return done

    def remote(self, *words, fails=False, variables=None):
        """Runs with this store; returns what it says."""
        env = self.environment(self.server.environment() if variables is None else variables)
        done = subprocess.run([VANTAGE, *map(str, words)], capture_output=True, text=True, env=env,
                              timeout=120)
        said = done.stdout + done.stderr
        self.assertEqual(done.returncode != 0, fails, f"{words}: {done.returncode} {said}")
        self.assertNotIn(SECRET, said)
        if fails:
            self.assertEqual(said.count("\n"), 1, said)
        return said

    def results_of(self, name, run, *words):
        out = Path(self.out.name) / name
        run("run", *words, "-o", out, *MATCH)
        return all_bytes(out)

    def asked(self, method=None, part=""):
        return [path for used, path, _ in self.server.requests
                if used == (method or used) and part in path]

    # Inputs

    def test_images(self):
        self.local("match", "data/left/000000.png", "data/right/000000.png", "-o", "local.pfm",
                   *MATCH)
        web = self.server.url + "/web"
        odd = ["s3://data/odd/a b+é&=%41.png", f"{web}/odd/a%20b+é&=%2541.png"]
        for left in ("s3://data/left/000000.png", f"{web}/left/000000.png", *odd):
            self.server.requests.clear()
            self.remote("match", left, "s3://data/right/000000.png", "-o", "remote.pfm", *MATCH)
            self.assertEqual(Path("remote.pfm").read_bytes(), Path("local.pfm").read_bytes(), left)
            self.assertEqual(len(self.asked("GET")), 2, self.asked())
        self.remote("synth", "s3://data/left/000000.png", "s3://data/right/000000.png", "-o",
                    "remote.png", "--view", "0.5", *MATCH)
        self.local("synth", "data/left/000000.png", "data/right/000000.png", "-o", "local.png",
                   "--view", "0.5", *MATCH)
        self.assertEqual(Path("remote.png").read_bytes(), Path("local.png").read_bytes())

    def test_sequences(self):
        local = self.results_of("local", self.local, "--left", "data/left", "--right", "data/right")
        self.assertEqual(len(local), FRAMES)
        for name, end in (("folder", "/"), ("bare", ""), ("pattern", "/%06d.png"), ("glob", "/*.png")):
            self.server.requests.clear()
            found = self.results_of(name, self.remote, "--left", f"s3://data/left{end}",
                                    "--right", f"s3://data/right{end}")
            self.assertEqual(found, local, name)
            # Once each, and for what a run finds out before it begins: range, rows, noise.
            self.assertLessEqual(len(self.asked("GET", "0.png")), 10, self.asked())
            self.assertLessEqual(len(self.asked("GET", "5.png")), 4, self.asked())
            self.assertEqual(self.asked("HEAD", ".png" if end in ("/", "") else "00000"), [])
        listed = self.results_of("listed", self.remote, "--pairs", "s3://data/lists/pairs.csv")
        self.assertEqual(listed, self.results_of("local-list", self.local, "--pairs",
                                                 "data/lists/pairs.csv"))
        mixed = self.folder / "mixed.csv"
        mixed.write_text("s3://data/left/000000.png,data/right/000000.png\n")
        self.results_of("mixed", self.remote, "--pairs", mixed)

    def test_files_of_other_kinds(self):
        """Calibrations, settings, lists, maps, scenes."""
        pair = ["{}left/000000.png", "{}right/000000.png"]
        for name, words in (
                ("rectify", ["rectify", *pair, "--calibration", "{}calib.txt", "-o", "OUT"]),
                ("match", ["match", *pair, "--calibration", "{}calib.txt", "--config",
                           "{}match.toml", "--depth", "OUT/depth.pfm", "-o", "OUT/map.pfm"]),
                ("scene", ["scene", "build", "--images", "{}left/00000[012].png", "-o", "OUT",
                           "--disparities=0:9"])):
            found = []
            for root, run in (("data/", self.local), ("s3://data/", self.remote)):
                out = Path(self.out.name) / (name + str(len(found)))
                out.mkdir()
                run(*(word.format(root).replace("OUT", str(out)) for word in words), "--quiet")
                found.append({file: content for file, content in all_bytes(out).items()
                              if file != "scene.json"})
            self.assertEqual(found[0], found[1], name)
            self.assertGreaterEqual(len(found[0]), 2)
        self.remote("scene", "view", out, "--at", "0.5,0", "-o", "scene.png", "--quiet")
        self.remote("check", "s3://data/left/", "s3://data/right/")
        self.server.put("map.pfm", Path("scene/left-disparity.pfm").read_bytes()
                        if Path("scene/left-disparity.pfm").exists() else
                        next(Path(self.out.name).rglob("map.pfm")).read_bytes())
        self.assertIn("A99", self.remote("eval", "s3://data/map.pfm", "s3://data/map.pfm"))

    def test_resumed_run(self):
        words = ["--left", "s3://data/left/", "--right", "s3://data/right/"]
        out = Path(self.out.name) / "resumed"
        self.remote("run", *words, "-o", out, *MATCH, "--chunk-frames", 2, "--frames", "0-1")
        self.remote("run", "-o", out, "--resume", "--frames", "2-5", "--quiet")
        self.assertEqual(all_bytes(out), self.results_of("local", self.local, "--left", "data/left",
                                                         "--right", "data/right"))
        self.server.put("left/000005.png", (self.data / "left/000001.png").read_bytes())
        said = self.remote("run", "-o", out, "--resume", "--quiet", fails=True)
        self.assertIn("images s3://data/left/", said)

    def test_films(self):
        for film in ("front.mp4", "end.mp4", "film.mkv", "sound.avi"):
            local, found = (
                self.results_of(name + film, run, "--left", root + film, "--right", root + film,
                                "--save", "disparity,views", "--video", "views", "--view", "0")
                for name, run, root in (("local", self.local, "data/"),
                                        ("remote", self.remote, "s3://data/")))
            self.assertEqual(found, local, film)
            # One block each for structure, packets and sound, kept from one opening to the next.
            self.assertLessEqual(len(self.asked("GET", film)), 2, self.asked())
            self.assertLessEqual(len(self.asked("HEAD", film)), 2, self.asked())
        self.assertTrue(any(b"mp4a" in content for content in found.values()))

    def test_large_film(self):
        """Read in blocks, each once a pass, whatever FFmpeg asks for; passes as from a disk: for the
        times of each of both, for samples, and to decode both."""
        words = ["--left", "{}large.y4m", "--right", "{}large.y4m", "--every", "10"]
        local, found = (
            self.results_of(name, run, *(word.format(root) for word in words))
            for name, run, root in (("local", self.local, "data/"),
                                    ("remote", self.remote, "s3://data/")))
        self.assertEqual(found, local)
        blocks = -(-(self.data / "large.y4m").stat().st_size // (4 * MIB))
        self.assertGreater(blocks, 4, "more than are kept")
        self.assertLessEqual(len(self.asked("GET", "large")), 4 * blocks, self.asked())

    def test_faults(self):
        faults = self.server.faults
        local = self.results_of("local", self.local, "--left", "data/left", "--right", "data/right")
        faults.busy_share, faults.cut_share = 0.15, 0.15
        found = self.results_of("faults", self.remote, "--left", "s3://data/left/",
                                "--right", "s3://data/right/")
        self.assertEqual(found, local)
        film = self.results_of("film-faults", self.remote, "--left", "s3://data/end.mp4",
                               "--right", "s3://data/film.mkv")
        faults.busy_share = faults.cut_share = 0
        self.assertEqual(film, self.results_of("film", self.local, "--left", "data/end.mp4",
                                               "--right", "data/film.mkv"))
        faults.slow_bytes_per_s = 20000
        self.remote("match", "s3://data/left/000000.png", "s3://data/right/000000.png", "-o",
                    "slow.pfm", *MATCH)
        faults.slow_bytes_per_s = None
        faults.busy_share, faults.retry_after = 0.6, 1
        faults.random.seed(1)  # busy at first
        begin = time.monotonic()
        self.remote("match", "s3://data/left/000000.png", "data/right/000000.png", "-o",
                    "again.pfm", *MATCH)
        self.assertGreater(time.monotonic() - begin, 1, "Retry-After counts")
        faults.busy_share = 0
        web = self.server.url + "/web"
        for no_ranges in (True, False):
            faults.no_ranges = no_ranges
            self.assertEqual(film, self.results_of(f"web-{no_ranges}", self.remote, "--left",
                                                   f"{web}/end.mp4", "--right", f"{web}/film.mkv"))

    def test_replaced_objects(self):
        changed = "has changed since it was begun, expected the same object"
        self.server.faults.replace_after = ("large.y4m", 2, "large.y4m", b"YUV4MPEG2 W9 H9\n")
        said = self.remote("run", "--left", "s3://data/large.y4m", "--right", "s3://data/large.y4m",
                           "-o", Path(self.out.name) / "film", *MATCH, fails=True)
        self.assertIn(f"s3://data/large.y4m: {changed}", said)
        self.server.faults.replace_after = ("left/000000.png", 1, "left/000003.png", b"another")
        said = self.remote("run", "--left", "s3://data/left/", "--right", "s3://data/right/", "-o",
                           Path(self.out.name) / "images", *MATCH, fails=True)
        self.assertIn(f"s3://data/left/000003.png: {changed}", said)

    # Outputs

    def test_outputs(self):
        pair = ["s3://data/left/000000.png", "s3://data/right/000000.png"]
        self.remote("match", *pair, "-o", "s3://data/out/map.pfm", *MATCH)
        self.local("match", "data/left/000000.png", "data/right/000000.png", "-o", "map.pfm", *MATCH)
        stored = self.server.buckets["data"]["out/map.pfm"]
        self.assertEqual(stored.content, Path("map.pfm").read_bytes())
        self.assertIsNotNone(stored.checksum)
        self.remote("match", "data/left/000000.png", "data/right/000000.png", "-o",
                    "s3://data/left/000000.pfm", "--report", "s3://data/out/report.json", *MATCH)
        json.loads(self.server.buckets["data"]["out/report.json"].content)
        large = b"P5 2200 2000 255\n" + bytes(range(250)) * 17600
        Path("large.pgm").write_bytes(large)
        self.remote("match", "large.pgm", "large.pgm", "-o", "s3://data/out/large.pfm", "--raw",
                    "--disparities=0:1", "--method", "ssd", "--quiet")
        stored = self.server.buckets["data"]["out/large.pfm"]
        self.assertEqual((stored.checksum, len(stored.content) > 16 * MIB), ("2 parts", True))
        self.assertEqual(self.server.uploads, {})
        said = self.remote("match", *pair, "-o", "s3://data/out/a.pfm", "--confidence",
                           "s3://data/./out/a.pfm", *MATCH, fails=True)
        self.assertIn("--output and --confidence are the same file", said)
        for output, expected in (("s3://data/left/000000.png", "which is also an input"),
                                 ("s3://none/map.png", "there is no bucket 'none'"),
                                 (self.server.url + "/web/map.png", "cannot be written")):
            said = self.remote("match", *pair, "-o", output, *MATCH, fails=True)
            self.assertIn(expected, said)
        said = self.remote("run", "--left", "s3://data/left/", "--right", "s3://data/right/", "-o",
                           "s3://data/results", *MATCH, fails=True)
        self.assertIn("expected a local folder", said)

    # What goes wrong

    def refusal(self, words=None, server=None, **variables):
        known = {**self.server.environment(), **variables}
        known = {name: value for name, value in known.items() if value is not None}
        return self.remote(*(words or ["match", "s3://data/left/000000.png",
                                       "data/right/000000.png", "-o", "no.pfm", *MATCH]),
                           fails=True, variables=known)

    def test_messages(self):
        name = "s3://data/left/000000.png"
        self.assertIn("there are no keys for S3", self.refusal(AWS_ACCESS_KEY_ID=None))
        self.assertIn(f"its bucket is in the region {REGION}, expected AWS_REGION={REGION}",
                      self.refusal(AWS_REGION="us-west-2"))
        self.assertIn("does not know the access key", self.refusal(AWS_ACCESS_KEY_ID="OTHER"))
        self.assertIn("the secret key does not belong", self.refusal(AWS_SECRET_ACCESS_KEY="x"))
        self.assertIn(f"{name}: access is denied without keys", self.refusal(AWS_NO_SIGN_REQUEST="1"))
        self.assertIn("AWS_PROFILE is 'nobody'", self.refusal(AWS_PROFILE="nobody"))
        self.assertIn("AWS_ENDPOINT_URL is 'localhost:9'",
                      self.refusal(AWS_ENDPOINT_URL="localhost:9"))
        begin = time.monotonic()
        self.assertIn(f"cannot reach {name}", self.refusal(AWS_ENDPOINT_URL="http://127.0.0.1:9"))
        self.assertLess(time.monotonic() - begin, 5)
        self.assertIn("expected a store that speaks S3",
                      self.refusal(AWS_ENDPOINT_URL=self.server.url + "/page"))
        self.server.faults.clock_skew = True
        self.assertIn("the clock of this machine is 60 min behind", self.refusal())
        self.server.faults.clock_skew = False
        for words, expected in (
                (["match", "s3://data/none.png", name], "s3://data/none.png: no such object"),
                (["match", "s3://none/a.png", name], "there is no bucket 'none'"),
                (["run", "--left", "s3://data/none/", "--right", "s3://data/left/"],
                 "s3://data/none/: no such file or folder"),
                (["match", "https://u:" + SECRET + "@host/a.png", name], "expected https://HOST/PATH"),
                (["match", "https://u:word@host/a.png", name], "user or password"),
                (["match", f"{self.server.url}/web/none.png", name], "no such file")):
            said = self.refusal([*words, "-o", "no.pfm", *MATCH])
            self.assertIn(expected, said)
        if EVERYTHING:  # it waits for 10 s
            self.server.faults.busy_share = 1
            self.assertIn("its server answers 503 (8 attempts)", self.refusal())

    def test_credentials(self):
        """Each source alone; those that expire are fetched again."""
        pair = ["match", "s3://data/left/000000.png", "data/right/000000.png", "-o", "keys.pfm",
                *MATCH]
        place = {"AWS_ENDPOINT_URL": self.server.url}
        self.server.session_token = "token/+="
        Path("credentials").write_text(
            f"[default]\naws_access_key_id=x\naws_secret_access_key=y\n[work]\naws_access_key_id = "
            f"{KEY_ID}\naws_secret_access_key = {SECRET}\naws_session_token=token/+=\n")
        Path("config").write_text(f"[profile work]\nregion={REGION}\n")
        self.remote(*pair, variables={**place, "AWS_PROFILE": "work",
                                      "AWS_CONFIG_FILE": "config",
                                      "AWS_SHARED_CREDENTIALS_FILE": "credentials"})
        with credential_service() as (url, asked):
            region = {**place, "AWS_REGION": REGION}
            self.remote(*pair, variables={**region, "AWS_CONTAINER_CREDENTIALS_FULL_URI":
                                          url + "/container", "AWS_CONTAINER_AUTHORIZATION_TOKEN":
                                          "let me in"})
            self.remote(*pair, variables={**region, "AWS_EC2_METADATA_DISABLED": "false",
                                          "AWS_EC2_METADATA_SERVICE_ENDPOINT": url})
            Path("token").write_text("web/token\n")
            self.remote(*pair, variables={**region, "AWS_ROLE_ARN": "arn:a:b",
                                          "AWS_WEB_IDENTITY_TOKEN_FILE": "token",
                                          "AWS_ENDPOINT_URL_STS": url})
            self.assertGreaterEqual(asked.count("/latest/meta-data/iam/security-credentials/role"), 1)
        self.server.session_token = None
        self.server.buckets["public"] = self.server.buckets["data"]
        pair[1] = "s3://public/left/000000.png"
        self.remote(*pair, variables={**place, "AWS_NO_SIGN_REQUEST": "true"})

    @unittest.skipUnless(shutil.which("openssl"), "makes the certificate")
    def test_certificates(self):
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
                        "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj", "/CN=127.0.0.1",
                        "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", "key.pem", "-out",
                        "cert.pem"], check=True, capture_output=True)
        Path("both.pem").write_text(Path("key.pem").read_text() + Path("cert.pem").read_text())
        with ObjectServer(certificate="both.pem") as secure:
            secure.add_folder(self.data)
            known = {**secure.environment(), "AWS_CA_BUNDLE": "cert.pem"}
            for left, variables, expected in (
                    ("s3://data/left/000000.png", known, None),
                    ("s3://data/left/000000.png", secure.environment(), "certificate"),
                    (secure.url + "/web/left/000000.png", known, None),
                    (secure.url + "/moved/left/000000.png", known, None),
                    (secure.url + "/moved/left/000000.png", known, "cannot reach")):
                secure.moved_to = (self.server if expected else secure).url + "/web"
                said = self.remote("match", left, "data/right/000000.png", "-o", "secure.pfm",
                                   *MATCH, fails=expected is not None, variables=variables)
                self.assertIn(expected or "", said)

    def interrupted(self, silent, *words):
        """Runs until a path with the text `silent` is asked for, then is interrupted."""
        self.server.faults.silent = silent
        self.server.requests.clear()
        env = self.environment(self.server.environment())
        process = subprocess.Popen([VANTAGE, *map(str, words), *MATCH], env=env,
                                   stderr=subprocess.PIPE)
        deadline = time.monotonic() + 30
        while not self.asked(part=silent) and time.monotonic() < deadline:
            time.sleep(0.02)
        time.sleep(0.2)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.wait(30)
        process.stderr.close()
        self.assertLess(time.monotonic() - begin, 2)
        self.assertIn(process.returncode, (130, -signal.SIGINT))
        self.server.faults.silent = None

    def test_interruption(self):
        self.interrupted("left", "match", "s3://data/left/000000.png", "data/right/000000.png", "-o",
                         "x.pfm")
        out = Path(self.out.name) / "x"
        words = ["--left", "s3://data/left/", "--right", "data/right", "-o", out, "--rows", "as-is"]
        self.interrupted("left/000004", "run", *words)
        self.remote("run", "-o", out, "--resume", "--quiet")
        self.assertEqual(all_bytes(out), self.results_of("local", self.local, "--left", "data/left",
                                                         "--right", "data/right", "--rows", "as-is"))

@contextlib.contextmanager
def credential_service():
    """Keys of a container and of a machine (IMDSv2), which expire in 4 minutes."""
    asked = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def log_message(self, *_):
            pass

        def handle_any(self):
            asked.append(self.path)
            body = {"/latest/api/token": "of session", "/container": KEYS,
                    "/latest/meta-data/iam/security-credentials/": "role",
                    "/latest/meta-data/iam/security-credentials/role": KEYS,
                    "/?Action=AssumeRoleWithWebIdentity&RoleArn=arn%3Aa%3Ab&RoleSessionName=vantage"
                    "&Version=2011-06-15&WebIdentityToken=web%2Ftoken": OF_ROLE}.get(self.path)
            is_allowed = (
                self.path == "/latest/api/token"
                and self.headers["X-aws-ec2-metadata-token-ttl-seconds"] is not None
                or self.headers.get("X-aws-ec2-metadata-token") == "of session"
                or body == OF_ROLE
                or self.path == "/container" and self.headers["Authorization"] == "let me in")
            self.send_response(200 if body and is_allowed else 403)
            self.end_headers()
            self.wfile.write((body or "").encode())

        do_GET = do_PUT = handle_any

    keys = {"AccessKeyId": KEY_ID, "SecretAccessKey": SECRET, "Token": "token/+=",
            "Expiration": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(time.time() + 240))}
    KEYS = json.dumps(keys)
    OF_ROLE = (f"<Credentials><SessionToken>token/+=</SessionToken><SecretAccessKey>{SECRET}"
               f"</SecretAccessKey><Expiration>{keys['Expiration']}</Expiration><AccessKeyId>"
               f"{KEY_ID}</AccessKeyId></Credentials>")
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}", asked
        server.shutdown()


if __name__ == "__main__":
    VANTAGE = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=1)
