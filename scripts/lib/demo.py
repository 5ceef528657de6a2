"""Runs the demo: matches, synthesises and measures with the vantage binary, then writes the page.

Called by scripts/demo, which builds the binary and finds the photographs."""

import argparse
import json
import shlex
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import demo_report
import disparity_picture as picture

SWEEP_VIEWS = 73
SEQUENCE_FRAMES = 30
SEQUENCE_SIZE = (512, 384)
CROSS_CHECK_PX = 1
SPECKLE_SIZE_PX = 100
JUDGED_FRAMES = [0, 10, 20]
# The picture of the errors ends here; larger ones look the same.
LARGE_ERROR_PX = 8


@dataclass
class Scene:
    """A stereo pair, the truth of its left image, and how it is matched."""

    name: str
    origin: str  # where it comes from, for people
    left: str
    right: str
    truth: str
    truth_scale: int  # of an 8-bit truth; 0 for PFM
    disparities: str

    def truth_map(self, out):
        if self.truth_scale:
            return picture.read_grey_png(out / self.truth, self.truth_scale)
        return picture.read_pfm(out / self.truth)


@dataclass
class Step:
    """One run of the binary: what it was for, how long it took, what its JSON report says."""

    title: str
    command: str
    seconds: float
    report: dict


class Demo:
    """The output folder, the binary and the steps so far, by name."""

    def __init__(self, vantage, out):
        self.vantage, self.out = vantage, out
        self.steps = {}

    def run(self, name, title, *arguments):
        """Runs `vantage ARGUMENTS` in the output folder; ends the demo when it fails."""
        arguments = [str(argument) for argument in arguments]
        shown = shlex.join(["vantage", *arguments])
        report = f"reports/{name}.json"
        start = time.monotonic()
        done = subprocess.run([self.vantage, *arguments, "--quiet", "--report", report],
                              cwd=self.out, capture_output=True, text=True, check=False)
        seconds = time.monotonic() - start
        if done.returncode != 0:
            sys.exit(f"demo: '{shown}' failed ({done.returncode}): "
                     f"{(done.stderr or done.stdout).strip()}")
        with open(self.out / report, encoding="utf-8") as file:
            step = Step(title, shown, seconds, json.load(file))
        self.steps[name] = step
        stages = ", ".join(f"{stage} {value:.3f} s"
                           for stage, value in step.report["seconds"]["stages"].items())
        print(f"{title:<46} {seconds:7.2f} s  {stages}", flush=True)
        return step.report


def photographs(demo, folder):
    """The aloe pair as it lies in `folder`, copied beside the results."""
    target = demo.out / "photographs"
    target.mkdir()
    for source, name in [("aloeL.jpg", "left.jpg"), ("aloeR.jpg", "right.jpg"),
                         ("aloeGT.png", "truth.png")]:
        shutil.copyfile(folder / source, target / name)
    return Scene(
        name="Aloe", origin="Middlebury stereo data set 2006, from the Debian package opencv-doc",
        left="photographs/left.jpg", right="photographs/right.jpg",
        truth="photographs/truth.png", truth_scale=1, disparities="32:223")


def generated_pair(demo):
    """A made-up pair of about the photographs' size, where those cannot be had."""
    report = demo.run("generate-pair", "generate scene: a pair with its truth",
                      "generate", "scene", "-o", "photographs", "--width", 1282, "--height", 1110)
    return Scene(
        name="Generated scene", origin="Made by 'vantage generate scene'",
        left="photographs/left.png", right="photographs/right.png",
        truth="photographs/left-disparity.pfm", truth_scale=0,
        disparities=report["results"]["disparities"])


def match_and_synthesise(demo, scene):
    """Both maps, their errors against the truth, the view between and the sweep."""
    for folder in ["maps", "views", "pictures"]:
        (demo.out / folder).mkdir()
    matching = ["--disparities", scene.disparities]
    refinement = ["--cross-check", CROSS_CHECK_PX, "--speckle-size", SPECKLE_SIZE_PX]
    demo.run("match", "match: both disparity maps", "match", scene.left, scene.right,
             "-o", "maps/left.pfm", "--output-right", "maps/right.pfm",
             "--unmatched", "maps/unmatched.png", "--preview", "maps/preview.png", *matching, *refinement)
    demo.run("match-raw", "match --raw: winner-take-all only", "match", scene.left, scene.right,
             "-o", "maps/left-raw.pfm", "--raw", *matching)
    scale = ["--scale", scene.truth_scale] if scene.truth_scale else []
    for name, file in [("eval", "left"), ("eval-raw", "left-raw")]:
        demo.run(name, f"eval: {file}.pfm against the truth", "eval", f"maps/{file}.pfm",
                 scene.truth, *scale)
    maps = ["--left-disparity", "maps/left.pfm", "--right-disparity", "maps/right.pfm"]
    demo.run("synth", "synth: the view half-way between", "synth", scene.left, scene.right,
             "-o", "views/centre.png", "--view", "0.5", *maps)
    demo.run("sweep", f"synth: a sweep of {SWEEP_VIEWS} views as a movie", "synth", scene.left, scene.right,
             "-o", "views/sweep.mp4", "--sweep", f"0:1:{SWEEP_VIEWS}", *maps)


def paint_maps(demo, scene):
    """The maps, the truth and the error as pictures that share one scale of colours."""
    truth = scene.truth_map(demo.out)
    known = sorted(value for row in truth.rows for value in row if value == value)
    low, high = known[len(known) // 1000], known[-1 - len(known) // 1000]
    left = picture.read_pfm(demo.out / "maps/left.pfm")
    right = picture.read_pfm(demo.out / "maps/right.pfm")
    raw = picture.read_pfm(demo.out / "maps/left-raw.pfm")
    for name, rows in [("left", left.rows), ("right", right.rows), ("left-raw", raw.rows),
                       ("truth", truth.rows)]:
        picture.write_png(demo.out / f"pictures/{name}.png", picture.paint(rows, low, high),
                          picture.TURBO)
    error = picture.absolute_difference(left, truth)
    picture.write_png(demo.out / "pictures/error.png", picture.paint(error, 0, LARGE_ERROR_PX),
                      picture.HEAT)
    return low, high


def run_sequence(demo):
    """A moving scene with truth, matched and rendered frame by frame, some frames judged."""
    report = demo.run("generate", f"generate scene: {SEQUENCE_FRAMES} frames of a moving scene",
                      "generate", "scene", "-o", "sequence/scene", "--frames", SEQUENCE_FRAMES,
                      "--frames-per-cycle", SEQUENCE_FRAMES, "--width", SEQUENCE_SIZE[0],
                      "--height", SEQUENCE_SIZE[1], "--samples", 2, "--view", "0.5")
    demo.run("run", "run: maps and the view half-way of every frame", "run",
             "--left", "sequence/scene/left", "--right", "sequence/scene/right",
             "-o", "sequence/results", "--save", "disparity,preview,views", "--view", "0.5",
             "--disparities", report["results"]["disparities"], "--cross-check", CROSS_CHECK_PX,
             "--speckle-size", SPECKLE_SIZE_PX)
    for frame in JUDGED_FRAMES:
        name = f"{frame:06}"
        demo.run(f"eval-{name}", f"eval: map of frame {frame} against the truth", "eval",
                 f"sequence/results/disparity/{name}.pfm",
                 f"sequence/scene/left-disparity/{name}.pfm")
        demo.run(f"eval-view-{name}", f"eval: view of frame {frame} against the truth", "eval",
                 "--views", f"sequence/results/views/{name}.png",
                 f"sequence/scene/views/{name}.png")


def main():
    parser = argparse.ArgumentParser(prog="demo.py", description=__doc__)
    parser.add_argument("--vantage", required=True, type=Path, help="the binary")
    parser.add_argument("--out", required=True, type=Path, help="folder to write, replaced")
    parser.add_argument("--photographs", type=Path, help="folder of the aloe pair")
    options = parser.parse_args()

    if options.out.exists():
        shutil.rmtree(options.out)
    (options.out / "reports").mkdir(parents=True)
    demo = Demo(options.vantage.resolve(), options.out)
    print("== running vantage", flush=True)
    if options.photographs:
        scene = photographs(demo, options.photographs)
    else:
        scene = generated_pair(demo)
    match_and_synthesise(demo, scene)
    run_sequence(demo)
    colours = paint_maps(demo, scene)
    demo_report.write(demo, scene, colours, JUDGED_FRAMES)
    print(f"== open {options.out}/index.html")


if __name__ == "__main__":
    main()
