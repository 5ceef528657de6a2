#!/usr/bin/env python3
"""Runs every shell block of the documents, so that what they tell users to type works.

usage: commands_test.py VANTAGE [--only DOCUMENT] [--verbose]

Blocks of a document run in order in one folder, which starts with the inputs that the documents
name (small generated scenes). Recipes are typed one after the other; of other documents a reader picks
a section, so `results` of earlier sections is removed. A block after the comment
`<!-- not run: REASON -->` is left out.
Prints each block that fails, with its place, and exits 1 when one does.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path += [str(ROOT / "tests/depths"), str(ROOT / "tests/asp")]
from plain_readers import read_png  # noqa: E402
from plain_tiff import write_tiff  # noqa: E402

DOCUMENTS = ["README.md", "CONTRIBUTING.md", "perf/README.md",
             *sorted(f"docs/{file.name}" for file in (ROOT / "docs").glob("*.md"))]
FENCE = re.compile(r"^```(\w*)\s*$")
NOT_RUN = re.compile(r"<!-- not run: .+ -->")


def shell_blocks(text):
    """Line number, text and number of the section of each shell block that is to be run."""
    blocks, block, start, kept, before, section = [], None, 0, True, "", 0
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if block is not None and line.startswith("```"):
            if kept:
                blocks.append((start, "\n".join(block), section))
            block = None
        elif block is not None:
            block.append(line)
        elif fence and fence.group(1) == "sh":
            block, start, kept = [], number + 1, not NOT_RUN.search(before)
        elif fence:
            block, kept = [], False
        elif line.strip():
            section += line.startswith("#")
            before = line
    return blocks


TYPED_IN_ORDER = {"docs/RECIPES.md"}

# Name in the documents → generated file.
COPIES = {
    "video.mp4": "film/stereo.mp4", "film.mp4": "film/stereo.mp4", "film.mkv": "film/stereo.mp4",
    "truth.pfm": "left-disparity.pfm",
    "photograph.png": "row/view-1.png",
    "first.png": "row/view-0.png", "second.png": "row/view-1.png", "third.png": "row/view-2.png",
    "upper.png": "row/view-0.png", "lower.png": "row/view-0,1.png", "a.png": "left.png", "b.png": "right.png",
    "training/image_2/000000_10.png": "left.png", "training/image_3/000000_10.png": "right.png",
    "photos/0.png": "row/view-0.png", "photos/1.png": "row/view-1.png",
    "photos/2.png": "row/view-2.png",
}


def rig_file(calib):
    """OpenCV's YAML of a rig, from Middlebury's calib.txt of a rectified one."""
    values = dict(line.split("=") for line in calib.splitlines())
    matrix = ", ".join(str(float(number)) for number in re.findall(r"[-.\d]+", values["cam0"]))

    def entry(name, rows, columns, data):
        return (f"{name}: !!opencv-matrix\n   rows: {rows}\n   cols: {columns}\n   dt: d\n"
                f"   data: [ {data} ]\n")
    return ("%YAML:1.0\n---\n" + entry("M1", 3, 3, matrix) + entry("M2", 3, 3, matrix) +
            entry("D1", 1, 5, "0., 0., 0., 0., 0.") + entry("D2", 1, 5, "0., 0., 0., 0., 0.") +
            entry("R", 3, 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") +
            entry("T", 3, 1, f"{-float(values['baseline'])}, 0., 0."))


def kitti_file(calib):
    """KITTI's calib_cam_to_cam.txt of the same rig; the grey cameras are a little farther apart."""
    values = dict(line.split("=") for line in calib.splitlines())
    focal, _, cx, _, _, cy = [float(n) for n in re.findall(r"[-.\d]+", values["cam0"])[:6]]
    text = "calib_time: 09-Jan-2012 13:57:47\n"
    for camera, baseline_m in enumerate([0, 0.54, 0, 0.53]):
        text += (f"P_rect_0{camera}: {focal} 0 {cx} {-focal * baseline_m} "
                 f"0 {focal} {cy} 0 0 0 1 0\n")
    return text


def write_grey_png(path, rows):
    """An 8-bit PNG of one channel."""
    def chunk(name, data):
        return (struct.pack(">I", len(data)) + name + data +
                struct.pack(">I", zlib.crc32(name + data)))
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) +
                     chunk(b"IEND", b""))


class Inputs:
    """A folder with the inputs that the documents name, made once and copied for each document."""

    def __init__(self, program, folder):
        self.program = program
        self.folder = folder
        self.vantage("generate scene --frames 6 --width 192 --height 144 --near 14 -o .")
        self.vantage("generate scene --width 192 --height 144 --near 14 -o .")
        self.vantage("run --left left --right right --disparities 0:15 --save stereo "
                     "--stereo-packing sbsl --video stereo --preset fast -o film")
        self.vantage("generate scene --width 192 --height 144 --near 14 --view 0 --view 1 --view 2 --view 0,1 "
                     "-o row")
        for name, source in COPIES.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(folder / source, folder / name)
        (folder / "training/disp_occ_0").mkdir()
        self.vantage("match left.png right.png -o training/disp_occ_0/000000_10.png")
        for used in ("film", "row"):
            shutil.rmtree(folder / used)
        for side in ("left", "right"):
            rows = [[float(pixel[0]) for pixel in row] for row in read_png(folder / f"{side}.png")]
            write_tiff(folder / f"tile-{side}.tif", rows)
        (folder / "poses.txt").write_text(  # KITTI's: each frame half a metre ahead
            "".join(f"1 0 0 0 0 1 0 0 0 0 1 {0.5 * frame}\n" for frame in range(6)))
        calib = (folder / "calib.txt").read_text()
        (folder / "rig.yml").write_text(rig_file(calib))
        (folder / "training/calib_cam_to_cam").mkdir()
        (folder / "training/calib_cam_to_cam/000000.txt").write_text(kitti_file(calib))
        occluded = read_png(folder / "left-occluded.png")
        write_grey_png(folder / "visible.png", [[255 - pixel[0] for pixel in row] for row in occluded])

    def vantage(self, words):
        subprocess.run([self.program, *words.split(), "--quiet"], cwd=self.folder, check=True)


def run_document(program, document, inputs, work, verbose):
    """The blocks that failed, as texts."""
    folder = work / document.replace("/", "-")
    subprocess.run(["cp", "-r", inputs, folder], check=True)
    environment = dict(os.environ, PATH=f"{pathlib.Path(program).parent}:{os.environ['PATH']}",
                       TERM="dumb")
    failures = []
    latest = 0
    for line, block, section in shell_blocks((ROOT / document).read_text()):
        if section != latest and document not in TYPED_IN_ORDER:
            shutil.rmtree(folder / "results", ignore_errors=True)
        latest = section
        start = time.monotonic()
        result = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=folder, text=True,
                                env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                stdin=subprocess.DEVNULL)
        if verbose:
            print(f"{document}:{line}: exit {result.returncode}, {time.monotonic() - start:.1f} s")
        if result.returncode != 0:
            last_lines = "\n    ".join(result.stdout.strip().splitlines()[-3:])
            failures.append(f"{document}:{line}: exit {result.returncode}\n    {last_lines}")
    return failures


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--only")
    parser.add_argument("--verbose", action="store_true")
    arguments = parser.parse_args()
    documents = [document for document in DOCUMENTS
                 if arguments.only in (None, document)]
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        (work / "inputs").mkdir()
        program = os.path.abspath(arguments.program)
        inputs = Inputs(program, work / "inputs").folder
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            failures = sum(pool.map(lambda document: run_document(
                program, document, inputs, work, arguments.verbose), documents), [])
    for failure in failures:
        print(failure)
    print(f"commands of documents: {len(failures)} blocks failed")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
