#!/usr/bin/env python3
"""Makes the inputs that fuzzing begins with, small files of each format.

usage: make_seeds.py PROGRAM FOLDER

FOLDER/TARGET gets the seeds of each target of tests/fuzz: files that PROGRAM, OpenCV and Python write, and
the texts below. FOLDER/TARGET.dict gets the words of a format, where it has some."""

import json
import os
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np

MIDDLEBURY = "cam0=[90 0 16; 0 90 12; 0 0 1]\ncam1=[90 0 17.5; 0 90 12; 0 0 1]\ndoffs=1.5\nbaseline=100\n" \
             "width=32\nheight=24\nndisp=16\n"
KITTI = "".join(f"P{i}: 90 0 16 {-45 * i} 0 90 12 0 0 0 1 0\n" for i in range(4))
OPENCV = "%YAML:1.0\n---\nimage_width: 32\nimage_height: 24\n" + "".join(
    f"{name}: !!opencv-matrix\n   rows: {rows}\n   cols: {columns}\n   dt: d\n   data: [ {data} ]\n"
    for name, rows, columns, data in (
        ("M1", 3, 3, "90., 0., 16., 0., 90., 12., 0., 0., 1."), ("D1", 1, 5, "0.1, -0.02, 0., 0.001, 0."),
        ("M2", 3, 3, "91., 0., 15., 0., 91., 12., 0., 0., 1."), ("D2", 1, 5, "0.1, 0.02, 0., 0., 0."),
        ("R", 3, 3, "1., 0., 0., 0., 1., 0., 0., 0., 1."), ("T", 3, 1, "-0.5, 0.001, 0.")))
KALIBR = "".join(f"cam{i}:\n  camera_model: pinhole\n  intrinsics: [90.0, 90.0, 16.0, 12.0]\n"
                 "  distortion_model: equidistant\n  distortion_coeffs: [0.01, 0.0, 0.0, 0.0]\n"
                 "  resolution: [32, 24]\n" for i in range(2)) + \
    "  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.11]\n  - [0.0, 1.0, 0.0, 0.0]\n  - [0.0, 0.0, 1.0, 0.0]\n  - [0, 0, 0, 1]\n"
ORB = "Camera1.fx: 90.0\nCamera1.fy: 90.0\nCamera1.cx: 16.0\nCamera1.cy: 12.0\nCamera.bf: 45.0\n" \
      "Camera.width: 32\nCamera.height: 24\n"
ROS = "image_width: 32\nimage_height: 24\ndistortion_model: plumb_bob\ncamera_matrix:\n  rows: 3\n  cols: 3\n" \
      "  data: [90, 0, 16, 0, 90, 12, 0, 0, 1]\nprojection_matrix:\n  rows: 3\n  cols: 4\n" \
      "  data: [90, 0, 16, %s, 0, 90, 12, 0, 0, 0, 1, 0]\n"
XML = "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>32</image_width>\n<fx>90</fx><fy>90</fy>" \
      "<cx>16</cx><cy>12</cy><baseline>0.5</baseline>\n</opencv_storage>\n"
COLMAP = b"# cameras\n1 PINHOLE 32 24 90 90 16 12\n2 OPENCV 32 24 90 90 16 12 0.1 0 0 0\n\0" \
         b"1 1 0 0 0 0 0 0 1 a.png\n\n2 1 0 0 0 -0.5 0 0 2 b.png\n1 2 3\n"
POSES = {"view": [{"at": [0.5, 0]}, {"frame": 3, "size": [30, 20], "K": [[90, 0, 16], [0, 90, 12], [0, 0, 1]],
                                     "R": [1, 0, 0, 0, 1, 0, 0, 0, 1], "t": [-0.1, 0, 0]}]}

TEXTS = {
    "calibration": [MIDDLEBURY, KITTI, OPENCV, KALIBR, ORB, XML, ROS % 0 + "\0" + ROS % -45,
                    json.dumps({"fx": 90, "fy": 90, "cx": 16, "cy": 12, "baseline": 0.5, "width": 32})],
    "intrinsics": ["90 90 16 12 0.1 0 0 0", KITTI, ROS % 0, XML, ORB, OPENCV + "extrinsic_parameters: "
                   "!!opencv-matrix\n   rows: 2\n   cols: 6\n   dt: d\n   data: [ 0,0,0,0,0,0, 0,0.1,0,-1,0,0 ]\n"],
    "colmap": [COLMAP],
    "board": ["9x6:0.025", "9x6", "14x9:0.02:0.015:DICT_5X5_250"],
    "pairs": ["left,right\na.png,b.png\n", "left;right;calibration;name\na.png;b.png;c.yml;one\n",
              "a.png b.png\n# comment\n\"c \"\"d\".png,e.png\n"],
    "positions": ["image,x,y\na.png,0,0\nb.png,1.5,-2e0\n", "a.png,0,0\nb.png,1,0\n"],
    "trajectory": ["1.5 0 0 0 0 0 0 1\n2.5 1 0 0 0 0 0.1 1\n", "1 0 0 0 0 1 0 0 0 0 1 0\n", "#t\n1403636579763555584,"
                   "0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n", json.dumps({"camera_angle_x": 0.6, "frames": [
                       {"file_path": "a.png", "transform_matrix": np.eye(4).tolist()}]})],
    "pose_json": [json.dumps(POSES)],
    "pose_toml": ["[[view]]\nat = [0.5, 0.0]\n[[view]]\nframe = 3\nK = [[90,0,16],[0,90,12],[0,0,1]]\n"
                  "R = [1,0,0,0,1,0,0,0,1]\nt = [-0.1, 0.0, 0.0]\nsize = [30, 20]\n"],
    "toml": ["a.b.'c d' = [1, {x = 0x1f, y = 'z'}]\nd = 1979-05-27T07:32:00Z\n[[e]]\nf = \"\\u00e9\"\n[e.g]\nh = inf\n"],
    "arguments": ["--left\na/\n--right=b/\n--disparities\n0:63\n--preset\nquality\n", "--threads\n4\n--window\n7\n",
                  "--stereo\nf.mp4\n--packing\nsbsl\n--sequence\n0:9\n", "--cost\ncensus\n--smoothness=3\n"],
    "keywords": [json.dumps({"disparities": "0:63", "preset": "quality", "threads": 4, "window": 7}),
                 json.dumps({"left": "a/", "right": "b/", "step": 2, "gamma": 0.5, "holes": "texture"})],
    "store_answer": ["<ListBucketResult><EncodingType>url</EncodingType><IsTruncated>true</IsTruncated>"
                     "<NextContinuationToken>a&amp;b</NextContinuationToken><CommonPrefixes><Prefix>b/</Prefix>"
                     "</CommonPrefixes><Contents><Key>a+b%2B</Key><Size>12</Size><ETag>&quot;e&quot;</ETag></Contents>",
                     "<Error><Code>NoSuchKey</Code><Message>m</Message><Region>r</Region></Error>"],
    "aws_profiles": ["[default]\naws_access_key_id = A\n[profile b]\nregion=c\ns3 =\n  endpoint_url = x\n"],
    "address": ["data/left/%06d.png", "https://host:443/a/../b%20c.png", "http://[::1]:80/"],
    "shots": [json.dumps({"shots": [{"first": 0, "end": 9, "range": [0, 63]}]}) + "\n"],
}
WORDS = {
    "png": ["IHDR", "PLTE", "IDAT", "IEND", "tRNS", "sBIT", "eXIf", "gAMA", "iCCP"],
    "jpeg": ["\\xff\\xd8", "\\xff\\xc0", "\\xff\\xc2", "\\xff\\xc4", "\\xff\\xda", "\\xff\\xdb", "\\xff\\xd9", "\\xff\\xe1",
             "\\xff\\xe2MPF\\x00", "_JPSJPS_", "Exif\\x00\\x00", "II*\\x00", "MM\\x00*"],
    "tiff": ["II*\\x00", "MM\\x00*", "II+\\x00", "\\x00\\x01\\x03\\x00", "\\x02\\x01", "\\x53\\x01", "\\x81\\xa4"],
    "pnm": ["P1", "P2", "P3", "P4", "P5", "P6", "PF", "Pf", "65535", "-1.0"],
    "picture": ["RIFF", "WEBP", "VP8 ", "VP8L", "VP8X", "BM", "v/1\\x01", "channels", "compression", "dataWindow"],
    "map": ["PF", "Pf", "\\x93NUMPY", "'descr': '<f4'", "'<u2'", "'fortran_order': True", "'shape': (", "II*\\x00"],
    "calibration": ["P0:", "P_rect_00:", "cam0=", "doffs=", "baseline", "M1", "D1", "R1", "P1", "Q", "T_cn_cnm1", "T_BS",
                    "T_cam_imu", "Camera.bf", "!!opencv-matrix", "rows:", "cols:", "data:", "equidistant", "fisheye"],
    "intrinsics": ["fx", "camera_matrix", "extrinsic_parameters", "distortion_model", "P2:", "PINHOLE"],
    "colmap": ["SIMPLE_PINHOLE", "PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV", "FULL_OPENCV", "OPENCV_FISHEYE"],
    "pairs": ["left", "right", "calibration", "name", "left_mask", "view", "time", "\\xef\\xbb\\xbf"],
    "video_structure": ["ftyp", "moov", "trak", "mdia", "minf", "stbl", "stsz", "stco", "co64", "stsc", "stts", "ctts",
                        "moof", "traf", "trun", "mdat", "hvcC", "avcC", "vexu", "RIFF", "AVI ", "movi", "idx1",
                        "\\x1a\\x45\\xdf\\xa3", "\\x18\\x53\\x80\\x67", "\\x1f\\x43\\xb6\\x75"],
    "video": ["YUV4MPEG2 ", "W16 ", "H16 ", "F25:1 ", "C420jpeg", "C444p16", "FRAME\\x0a", "Ip", "A1:1"],
    "scene_json": ['\\"images\\"', '\\"edges\\"', '\\"camera\\"', '\\"position\\"', '\\"graph\\"', '\\"refused\\"'],
    "journal": ['\\"frame\\":', '\\"files\\":', '\\"skipped\\":', '\\"segment\\":', '\\"joined\\":', '\\"report\\":'],
}


def run(program, *arguments):
    environment = dict(os.environ, XDG_CONFIG_HOME="/nonexistent")
    subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, env=environment)


class Seeds:
    def __init__(self, folder):
        self.folder = folder
        self.count = 0

    def add(self, target, content):
        folder = self.folder / target
        folder.mkdir(parents=True, exist_ok=True)
        self.count += 1
        content = content if isinstance(content, bytes) else content.encode()
        (folder / f"seed-{self.count:03}").write_bytes(content)

    def add_file(self, target, file):
        self.add(target, Path(file).read_bytes())


def add_pictures(seeds, work):
    random = np.random.default_rng(5)
    for depth in (np.uint8, np.uint16, np.float32):
        for shape in ((7, 13), (7, 13, 3), (6, 5, 4)):
            values = random.integers(0, 256, shape).astype(depth)
            targets = {np.uint8: {"png": "png", "tiff": "tiff", "jpg": "jpeg", "bmp": "picture", "webp": "picture",
                                  "ppm" if len(shape) == 3 else "pgm": "pnm"},
                       np.uint16: {"png": "png", "tiff": "tiff", "ppm" if len(shape) == 3 else "pgm": "pnm"},
                       np.float32: {"tiff": "tiff", "pfm": "pnm"}}[depth]
            for extension, target in targets.items():
                file = work / f"picture.{extension}"
                if shape[-1] == 4 and extension not in ("png", "tiff", "webp"):
                    continue
                if cv2.imwrite(str(file), values):
                    seeds.add_file(target, file)
    cv2.imwrite(str(work / "picture.jp2"), np.full((40, 70, 3), 90, np.uint8))
    seeds.add_file("picture", work / "picture.jp2")
    grey = np.zeros((6, 5), np.uint8)
    for name, value in {"compression": (1, 5, 8, 32773)}.items():
        for one in value:
            cv2.imwrite(str(work / "one.tiff"), grey, [cv2.IMWRITE_TIFF_COMPRESSION, one])
            seeds.add_file("tiff", work / "one.tiff")
    cv2.imwrite(str(work / "progressive.jpg"), grey, [cv2.IMWRITE_JPEG_PROGRESSIVE, 1])
    jpeg = (work / "progressive.jpg").read_bytes()
    seeds.add("jpeg", jpeg)
    exif = b"Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0"
    seeds.add("jpeg", jpeg[:2] + b"\xff\xe1" + (len(exif) + 2).to_bytes(2, "big") + exif + jpeg[2:])
    for text in ("P1\n3 2\n0 1 0\n1 1 0\n", "P2\n3 2\n15\n0 1 15\n3 4 5\n", "P3\n1 2\n255\n0 1 255\n3 4 5\n"):
        seeds.add("pnm", text)
    for kind in range(8):
        seeds.add("png_rows", bytes([9, 6, kind % 5, kind, kind % 2, kind]) + bytes(range(200)))
    for size in (60, 400, 1500):
        seeds.add("view", random.integers(0, 256, size).astype(np.uint8).tobytes())


def add_maps(seeds, work, disparity):
    values = np.load(disparity)[:6, :9] if disparity.suffix == ".npy" else None
    for dtype in ("<f4", "<f2", "<f8", "<u2", "<i2", "|u1", "<i8"):
        np.save(work / "map.npy", np.nan_to_num(values).astype(dtype))
        seeds.add_file("map", work / "map.npy")
    np.save(work / "map.npy", np.asfortranarray(values))
    seeds.add_file("map", work / "map.npy")
    for extension in ("pfm", "tiff"):
        cv2.imwrite(str(work / f"map.{extension}"), values.astype(np.float32))
        seeds.add_file("map", work / f"map.{extension}")
    cv2.imwrite(str(work / "map.png"), np.nan_to_num(values * 256).clip(0, 65535).astype(np.uint16))
    seeds.add_file("map", work / "map.png")


def add_runs(seeds, program, work):
    """A run of three frames with a film, a scene of three photographs, the tuner's file."""
    frames, results = work / "frames", work / "run"
    run(program, "generate", "scene", "--frames", 3, "--width", 64, "--height", 48, "-o", frames)
    run(program, "run", "--left", frames / "left", "--right", frames / "right", "--disparities", "0:8",
        "--save", "disparity,preview,depth-video", "--video", "preview,depth-video", "--quiet", "-o", results)
    seeds.add_file("run_json", results / ".vantage/run.json")
    for journal in (results / ".vantage").glob("*.jsonl"):
        for line in journal.read_text().splitlines():
            seeds.add("journal", line)
    for shots in (results / ".vantage").glob("shots*.json"):
        seeds.add_file("shots", shots)
    for video in results.glob("*.mp4"):
        seeds.add_file("video", video)
        seeds.add_file("video_structure", video)
    scene = work / "scene"
    run(program, "scene", "build", "--images", frames / "left", "--disparities", "0:8", "--quiet", "-o", scene)
    seeds.add_file("scene_json", scene / "scene.json")
    run(program, "tune", "--size", "64x48", "--budget", 1, "-o", work / "tuning.json")
    seeds.add_file("tuning", work / "tuning.json")
    small = work / "small"
    run(program, "generate", "scene", "--width", 24, "--height", 16, "-o", small)
    for file in (work / "disparity.exr", work / "disparity.npy"):
        run(program, "match", small / "left.png", small / "right.png", "--disparities", "0:4", "-o", file)
    seeds.add_file("picture", work / "disparity.exr")
    seeds.add_file("map", work / "disparity.exr")
    add_maps(seeds, work, work / "disparity.npy")
    config = subprocess.run([program, "run", "--print-config"], check=True, capture_output=True, text=True).stdout
    seeds.add("settings_toml", "\n".join(line for line in config.splitlines()
                                         if line.startswith(("window", "holes", "threads", "step", "cost"))))


def add_films(seeds, work):
    """Raw y4m, and containers that OpenCV's FFmpeg writes."""
    picture = bytes(range(96)) * 4
    for colours, size in (("420jpeg", 384), ("mono", 256), ("444", 768)):
        frame = b"FRAME\n" + (picture * 2)[:size]
        for target in ("video", "stream"):
            seeds.add(target, b"YUV4MPEG2 W16 H16 F25:1 Ip A1:1 C" + colours.encode() + b"\n" + frame * 3)
    for extension, code in (("avi", "MJPG"), ("mkv", "MJPG"), ("mov", "MJPG"), ("mp4", "mp4v"), ("ts", "mp4v")):
        file = work / f"film.{extension}"
        writer = cv2.VideoWriter(str(file), cv2.VideoWriter_fourcc(*code), 25, (32, 16))
        for i in range(3):
            writer.write(np.full((16, 32, 3), 40 * i, np.uint8))
        writer.release()
        if file.exists() and file.stat().st_size > 0:
            for target in ("video", "video_structure", "stream"):
                seeds.add_file(target, file)
    seeds.add("stream", bytes(55) + b"\7")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, folder = sys.argv[1], Path(sys.argv[2])
    work = folder / "work"
    work.mkdir(parents=True, exist_ok=True)
    seeds = Seeds(folder)
    for target, texts in TEXTS.items():
        for text in texts:
            seeds.add(target, text)
    for target, words in WORDS.items():
        (folder / f"{target}.dict").write_text("".join(f'"{word}"\n' for word in words))
    options = json.loads(subprocess.run([program, "run", "--help-json"], check=True, capture_output=True).stdout)
    names = [option["name"] for option in options["options"]]
    for target in ("arguments", "keywords", "settings_toml"):
        dashes = "--" if target == "arguments" else ""
        (folder / f"{target}.dict").write_text("".join(f'"{dashes}{name.lstrip("-")}"\n' for name in names))
    add_pictures(seeds, work)
    (folder / "stream.dict").write_text((folder / "video.dict").read_text())
    add_films(seeds, work)
    add_runs(seeds, program, work)


main()
