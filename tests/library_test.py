"""The shared library, as another language calls it: usage library_test.py PROGRAM LIBRARY SOURCE_DIR"""

import ctypes
import itertools
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop()) / "engine/library"
LIBRARY = Path(sys.argv.pop())
PROGRAM = sys.argv.pop()
OK, ERROR, USAGE = 0, 1, 2
WIDTH, HEIGHT = 203, 131

api = ctypes.CDLL(str(LIBRARY))
for function in ["vantage_version", "vantage_last_error", "vantage_pair_remark"]:
    getattr(api, function).restype = ctypes.c_char_p


class Picture(ctypes.Structure):
    """vantage_image and vantage_picture"""
    _fields_ = [("struct_size", ctypes.c_size_t), ("pixels", ctypes.c_void_p),
                ("width_px", ctypes.c_int32), ("height_px", ctypes.c_int32),
                ("row_bytes", ctypes.c_ssize_t), ("channels", ctypes.c_int32),
                ("bits", ctypes.c_int32), ("is_bgr", ctypes.c_int32), ("reserved", ctypes.c_int32),
                ("later", ctypes.c_int64)]


def picture(pixels, channels=3, bits=8, **fields):
    return Picture(**{"struct_size": ctypes.sizeof(Picture),
                      "pixels": ctypes.cast(pixels, ctypes.c_void_p), "width_px": WIDTH,
                      "height_px": HEIGHT, "channels": channels, "bits": bits, **fields})


def matcher(*options):
    texts = (ctypes.c_char_p * len(options))(*(option.encode() for option in options))
    handle = ctypes.c_void_p()
    status = api.vantage_matcher_create(texts, ctypes.c_size_t(len(options)), ctypes.byref(handle))
    return status, handle


def match(handle, left, right):
    pair = ctypes.c_void_p()
    status = api.vantage_match(handle, ctypes.byref(left), ctypes.byref(right), ctypes.byref(pair))
    return status, pair


class LibraryTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        os.chdir(cls.folder.name)
        cls.run_program("generate", "scene", "-o", "scene", "--width", str(WIDTH), "--height",
                        str(HEIGHT), "--samples", "1", "--noise", "1")
        for position, side in enumerate(["left", "right"]):
            cls.run_program("synth", "scene/left.png", "scene/right.png", "--view", str(position),
                            "--disparities", "1:16", "-o", f"{side}.ppm")
        with open("right.ppm", "r+b") as file:  # 1 px lower: its rows are corrected
            header = file.read()[:-3 * WIDTH * HEIGHT]
            file.seek(len(header))
            pixels = file.read()
            file.seek(len(header))
            file.write(pixels[:3 * WIDTH] + pixels[:-3 * WIDTH])
        cls.pixels = [Path(f"{side}.ppm").read_bytes()[-3 * WIDTH * HEIGHT:]
                      for side in ["left", "right"]]

    @classmethod
    def tearDownClass(cls):
        os.chdir("/")
        cls.folder.cleanup()

    @staticmethod
    def run_program(*words):
        subprocess.run([PROGRAM, *words, "--quiet"], check=True)

    def expect_error(self, status, expected, text):
        self.assertEqual((status, text in api.vantage_last_error().decode()), (expected, True),
                         api.vantage_last_error())

    def test_exports_what_the_header_declares(self):
        listing = subprocess.run(["nm", "-D", "--defined-only", LIBRARY], check=True,
                                 capture_output=True, text=True).stdout
        exported = {line.split()[2].split("@")[0] for line in listing.splitlines()} - {"VANTAGE_0"}
        header = (SOURCE / "vantage_c.h").read_text(encoding="utf-8")
        self.assertEqual(exported, set(re.findall(r"^\w.*?(vantage_\w+)\(", header, re.MULTILINE)))
        self.assertIn("libvantage.so.0]", subprocess.run(
            ["readelf", "-d", LIBRARY], check=True, capture_output=True, text=True).stdout)

    def test_gives_the_bytes_of_the_program(self):
        options = ["disparities=1:16", "preset=balanced", "threads=2"]
        status, handle = matcher(*options)
        self.assertEqual(status, OK, api.vantage_last_error())
        status, pair = match(handle, *(picture(pixels) for pixels in self.pixels))
        self.assertEqual(status, OK, api.vantage_last_error())
        api.vantage_matcher_destroy(handle)  # the pair lives on
        given = ["left.ppm", "right.ppm", "--disparities", "1:16"]
        for side, name in enumerate(["left", "right"]):
            self.run_program("match", *given, "--reference", name, "-o", f"disparity-{side}.pfm",
                             "--confidence", f"confidence-{side}.pfm")
        self.run_program("synth", *given, "--view", "0.5,0.1", "-o", "view.ppm")
        row = 4 * WIDTH + 8  # some bytes between rows stay as they are
        for name, side in itertools.product(["disparity", "confidence"], [0, 1]):
            values = ctypes.create_string_buffer(b"\7" * (row * HEIGHT), row * HEIGHT)
            room = picture(values, channels=1, bits=32, row_bytes=row)
            self.assertEqual(getattr(api, f"vantage_pair_{name}")(pair, side, ctypes.byref(room)), OK,
                             api.vantage_last_error())
            rows = [values.raw[y * row:(y + 1) * row] for y in range(HEIGHT)]
            self.assertEqual({line[4 * WIDTH:] for line in rows}, {b"\7" * 8})
            upwards = b"".join(line[:4 * WIDTH] for line in reversed(rows))
            self.assertEqual(upwards, Path(f"{name}-{side}.pfm").read_bytes()[-4 * WIDTH * HEIGHT:])
        values = ctypes.create_string_buffer(3 * WIDTH * HEIGHT)
        room = picture(values, is_bgr=1)
        self.assertEqual(api.vantage_pair_view(pair, ctypes.c_double(0.5), ctypes.c_double(0.1),
                                               ctypes.byref(room)), OK, api.vantage_last_error())
        view = Path("view.ppm").read_bytes()[-3 * WIDTH * HEIGHT:]
        self.assertEqual(values.raw[0::3] + values.raw[1::3], view[2::3] + view[1::3])
        api.vantage_pair_destroy(pair)

    def test_errors_are_statuses_and_lines(self):
        for option, text in [("preset", "expected NAME=VALUE"), ("presset=quality", "mean preset?"),
                             ("disparities=9:1", "disparities"), ("threads=0", "threads is 0")]:
            self.expect_error(matcher(option)[0], USAGE, text)
        handle = matcher("disparities=1:16")[1]
        left, right = (picture(pixels) for pixels in self.pixels)
        status, pair = match(handle, left, right)
        self.assertEqual(status, OK)
        for wrong, expected, text in [({"struct_size": 8}, USAGE, "struct_size is 8"),
                                      ({"later": 1}, USAGE, "later version"),
                                      ({"reserved": 1}, USAGE, "later version"),
                                      ({"bits": 12}, USAGE, "bits are 12"),
                                      ({"width_px": 0}, ERROR, "left: "),
                                      ({"height_px": HEIGHT - 1}, ERROR, "equal shapes")]:
            other = picture(self.pixels[0], **wrong)
            self.expect_error(match(handle, other, right)[0], expected, text)
        room = picture(ctypes.create_string_buffer(4 * WIDTH * HEIGHT), channels=1)
        self.expect_error(api.vantage_pair_disparity(pair, 0, ctypes.byref(room)), USAGE,
                          "1 channels of 8 bits, expected")
        self.expect_error(api.vantage_pair_disparity(pair, 2, ctypes.byref(room)), USAGE, "side is 2")
        self.expect_error(api.vantage_pair_view(pair, ctypes.c_double(99), ctypes.c_double(0),
                                                ctypes.byref(picture(self.pixels[0]))), USAGE, "99")
        self.assertEqual(api.vantage_match(handle, None, None, ctypes.byref(pair)), USAGE)
        api.vantage_pair_destroy(None)


if __name__ == "__main__":
    unittest.main()
