"""Frames of a Sequence are those of `vantage run`, byte for byte; their threads end with the loop."""

import gc
import os
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import run_program, same, words

import vantage

RANGE = {"disparities": (0, 7)}


@pytest.fixture(scope="module")
def sequence(tmp_path_factory):
    """Folder of six pairs, 128x96, with a cut after the third: left/000000.png …"""
    folder = tmp_path_factory.mktemp("sequence")
    for part, seed in [("first", 1), ("second", 9)]:
        run_program("generate", "scene", "-o", folder / part, "--frames", 3, "--width", 128,
                    "--height", 96, "--seed", seed, "--quiet")
    for side in ["left", "right"]:
        shutil.move(folder / "first" / side, folder / side)
        for frame in range(3):
            shutil.move(folder / f"second/{side}/{frame:06}.png",
                        folder / side / f"{frame + 3:06}.png")
    shutil.move(folder / "first/calib.txt", folder / "calib.txt")
    return folder


def sides(folder):
    return {"left": folder / "left", "right": folder / "right"}


def stored(folder, name, frame):
    path = folder / name / f"{frame.index:06}.npy"
    return np.load(path) if path.exists() else vantage.read_image(path.with_suffix(".png"))


MAPS = {"disparity": "disparity", "right-disparity": "right_disparity", "confidence": "confidence",
        "posterior-mean": "posterior_mean", "posterior-variance": "posterior_variance",
        "cyclopean": "cyclopean", "cyclopean-occlusion": "cyclopean_occlusion"}


@pytest.mark.parametrize("options", [
    {},
    {"save": ["disparity", "confidence", "preview"], "search_range": "shot",
     "preview_range": "shot"},
    {**RANGE, "save": ["disparity", "right-disparity", "confidence", "posterior-mean",
                       "posterior-variance"], "temporal_prior": 1, "chunk_frames": 4},
    {**RANGE, "save": ["disparity", "confidence"], "reuse": "frame", "preset": "realtime",
     "temporal_threshold": 6},
    {**RANGE, "save": ["disparity", "cyclopean", "cyclopean-occlusion"], "selection": "symmetric",
     "every": 2},
    {**RANGE, "save": ["disparity", "preview", "views", "holes", "sources", "stereo"], "view": 0.5,
     "intensity_fit": "shot", "stereo_packing": "arcd"},
    {**RANGE, "reference": "right", "frames": "1-5:2", "offset": 1},
], ids=str)
def test_frames_are_those_of_a_run(sequence, tmp_path, options):
    run_program("run", *words(sides(sequence)), "-o", tmp_path / "run", "--format", "npy",
                *words(options), "--no-tuning")
    frames = vantage.Sequence(**sides(sequence), **options)
    saved = options.get("save", ["disparity"])
    seen = []
    for frame in frames:
        seen.append(frame.index)
        for name in saved:
            expected = stored(tmp_path / "run", name, frame)
            if name in MAPS:
                assert same(getattr(frame.result, MAPS[name]), expected), name
            elif name == "preview":
                assert same(frame.result.preview(), expected)
            elif name == "holes":
                assert np.array_equal(frame.holes[0], expected == 255)
            else:
                array = frame.stereo if name == "stereo" else getattr(frame, name)[0]
                assert same(array, expected), name
        assert (frame.share_reused is not None) == ("reuse" in options)
    stems = [path.stem for path in sorted((tmp_path / "run/disparity").iterdir())]
    assert stems == [f"{index:06}" for index in seen] and len(frames) == len(seen)
    assert frames.skipped == []


def test_what_frames_hold(sequence):
    frames = vantage.Sequence(**sides(sequence))
    for frame in frames:
        name = f"{frame.index:06}.png"
        assert name in frame.name and frame.views == [] and frame.stereo is None
        assert same(frame.left, vantage.read_image(sequence / "left" / name))
        assert same(frame.right, vantage.read_image(sequence / "right" / name))
        frame.left[:] = 0  # the caller's own
        # Computed when they are asked for, of the images alone.
        alone = vantage.Matcher(disparities=frame.result.disparities)(
            vantage.read_image(sequence / "left" / name), vantage.read_image(sequence / "right" / name))
        assert same(frame.result.right_disparity, alone.right_disparity)
        assert same(frame.result.confidence, alone.confidence)
    steady = next(iter(vantage.Sequence(**sides(sequence), **RANGE, reuse="frame")))
    with pytest.raises(vantage.Error, match="right_disparity depends on more than the images"):
        steady.result.right_disparity


def test_some_frames_are_as_in_the_whole(sequence):
    options = {**sides(sequence), **RANGE, "temporal_prior": 2, "save": "disparity,right_disparity"}
    whole = [(frame.disparity, frame.result.right_disparity)
             for frame in vantage.Sequence(**options)]
    for frames in [range(2, 4), slice(1, None, 2), range(5, 6), slice(0, 0)]:
        some = vantage.Sequence(**options, frames=frames, in_flight=1)
        found = [frame.index for frame in some]
        assert found == list(range(6)[frames] if isinstance(frames, slice) else frames)
        assert len(some) == len(found)
        for frame in some:
            assert same(frame.disparity, whole[frame.index][0])
            assert same(frame.result.right_disparity, whole[frame.index][1])
    # Loops within loops read the source each for itself.
    independent = vantage.Sequence(**sides(sequence), **RANGE)
    pairs = [(one.index, two.index) for one in independent for two in independent]
    assert pairs == [(one, two) for one in range(6) for two in range(6)]


def test_several_cameras(sequence, tmp_path):
    more = {"more": str(sequence / "left"), "baselines": [1, -0.5], **RANGE, "frames": "0-1"}
    run_program("run", *words(sides(sequence)), *words(more), "-o", tmp_path / "run", "--format",
                "npy")
    for frame in vantage.Sequence(**sides(sequence), **more):
        assert same(frame.disparity, stored(tmp_path / "run", "disparity", frame))
        with pytest.raises(vantage.Error, match="right_disparity depends on more"):
            frame.result.right_disparity


def test_metres_in_the_world(sequence, tmp_path):
    poses = tmp_path / "poses.txt"
    poses.write_text("".join(f"1 0 0 {frame} 0 1 0 0 0 0 1 0\n" for frame in range(6)))
    options = {**RANGE, "calibration": str(sequence / "calib.txt"), "poses": str(poses)}
    run_program("run", *words(sides(sequence)), *words(options), "-o", tmp_path / "run", "--save",
                "depth,cloud,mesh", "--depth-format", "npy", "--frames", "1-2")
    for frame in vantage.Sequence(**sides(sequence), **options, frames=range(1, 3)):
        assert same(frame.result.depth(), stored(tmp_path / "run", "depth", frame))
        for name, write, made in [("cloud", vantage.write_cloud, frame.result.cloud()),
                                  ("mesh", vantage.write_mesh, frame.result.mesh())]:
            write(tmp_path / "ours.ply", made)
            expected = tmp_path / f"run/{name}/{frame.index:06}.ply"
            assert (tmp_path / "ours.ply").read_bytes() == expected.read_bytes()
        assert frame.result.cloud(options["calibration"]).points[0, 0] < frame.result.cloud(
            ).points[0, 0]  # in the frame of the camera


@pytest.fixture
def long_sequence(sequence, tmp_path):
    """Twelve frames that may be removed."""
    for side in ["left", "right"]:
        (tmp_path / side).mkdir()
        for frame in range(12):
            shutil.copy(sequence / side / f"{frame % 3:06}.png", tmp_path / side / f"{frame:06}.png")
    return tmp_path


def test_frames_are_computed_ahead_but_not_all(long_sequence):
    frames = vantage.Sequence(**sides(long_sequence), **RANGE, in_flight=3)
    seen = []
    with pytest.raises(vantage.Error, match=r"frame [34] \(.*00000[34]\.png"):
        for frame in frames:
            seen.append(frame.index)
            if frame.index == 0:
                time.sleep(0.5)  # the next ones are computed meanwhile
                for side in ["left", "right"]:
                    shutil.rmtree(long_sequence / side)
    # One was taken, and two or three more were computed when the files vanished.
    assert seen in [[0, 1, 2], [0, 1, 2, 3]]


def thread_count():
    return len(os.listdir("/proc/self/task"))


def test_threads_end_with_the_loop(long_sequence):
    frames = vantage.Sequence(**sides(long_sequence), **RANGE)
    assert len(list(frames)) == 12  # the pool has its threads
    before = thread_count()
    for frame in frames:
        assert thread_count() == before + 1
        break
    assert thread_count() == before and frame.result.right_disparity.shape == (96, 128)
    with pytest.raises(ZeroDivisionError):
        for frame in frames:
            1 / (frame.index - 1)
    assert thread_count() == before
    loop = iter(frames)
    next(loop)
    cycle = [loop]
    cycle.append(cycle)
    del loop, cycle
    gc.collect()
    assert thread_count() == before
    loop = iter(frames)
    del frames
    assert len(list(loop)) == 12


def test_bad_frames(long_sequence):
    (long_sequence / "left/000004.png").write_bytes(b"\x89PNG\r\n\x1a\nno picture")
    seen = []
    with pytest.raises(vantage.Error, match=r"frame 4 \(.*000004.png") as problem:
        for frame in vantage.Sequence(**sides(long_sequence), **RANGE):
            seen.append(frame.index)
    assert seen == list(range(4)) and "\n" not in str(problem.value)
    tolerant = vantage.Sequence(**sides(long_sequence), **RANGE, keep_going=True)
    assert [frame.index for frame in tolerant] == [0, 1, 2, 3, *range(5, 12)]
    assert len(tolerant.skipped) == 1 and tolerant.skipped[0][0] == 4
    assert "000004.png" in tolerant.skipped[0][1]


@pytest.mark.parametrize("options, message", [
    ({"frames": range(9)}, "expected numbers from 0 to 5"),
    ({"frames": range(3, 0, -1)}, "expected increasing numbers"),
    ({"frames": [1, 2]}, "expected a range or a slice"),
    ({"frames": "9-12"}, "--frames starts at 9 but the input has 6 frames"),
    ({"save": ["cloud"]}, r"save holds cloud, expected frame.result.cloud\(\) instead"),
    ({"save": ["comfort"]}, "save holds comfort, expected 'vantage run' instead"),
    ({"save": "views"}, "view"),
    ({"reuse": "frame", "method": "ssd"}, "reuse"),
    ({"temporal_prior": 1, "search_range": "shot"}, "search-range"),
    ({"temporal_threshold": 3}, "temporal-threshold has no effect without"),
    ({"in_flight": 65}, "in-flight is 65"),
    ({"chunk_frames": 0}, "chunk-frames|chunk"),
    ({"disparities_y": (0, 1)}, "disparities-y"),
    ({"resume": True}, "unknown option 'resume'"),
    ({"baselines": [1, 2]}, "baselines has 2 numbers, expected 1"),
    ({"kept_outline": 0.5}, "kept-outline has no effect without --calibration"),
    ({"baseline": 0.1}, "baseline has no effect without --focal-length or --calibration"),
    ({"right": None, "stereo": "-", "left": None}, "packing|stereo is -"),
    ({"calibration": vantage.Calibration.from_focal_length(9, 1, image_size=(128, 96)),
      "already_rectified": True}, r"expected Calibration.load\(path, already_rectified=True\)"),
])
def test_bad_options(sequence, options, message):
    with pytest.raises(vantage.Error, match=message) as problem:
        vantage.Sequence(**{**sides(sequence), **options})
    assert "\n" not in str(problem.value)


def test_frames_that_one_camera_dropped(sequence, tmp_path):
    for side, dropped in [("left", 1), ("right", 3)]:
        shutil.copytree(sequence / side, tmp_path / side)
        (tmp_path / side / f"{dropped:06}.png").unlink()
    frames = vantage.Sequence(**sides(tmp_path), **RANGE)
    assert len(frames) == 4
    with pytest.warns(UserWarning, match="2 frames are left out without a partner"):
        for frame in frames:
            left, right = frame.name.split(", ")
            assert left.rsplit("/")[-1] == right.rsplit("/")[-1]
    assert len(vantage.Sequence(**sides(tmp_path), **RANGE, pair_by="order")) == 5


def test_inputs_that_are_missing(sequence):
    with pytest.raises(vantage.Error, match="missing"):
        vantage.Sequence(sequence / "missing", sequence / "right")
    with pytest.raises(ValueError, match="--stereo|--left|stereo"):
        vantage.Sequence()


SCRIPT = """
import sys, vantage
frames = vantage.Sequence(sys.argv[1], sys.argv[2], method="diffusion", disparities=(0, 63),
                          iterations=10000)
print("ready", flush=True)
try:
    for frame in frames:
        pass
except KeyboardInterrupt:
    print("interrupted")
"""
LEAVING = """
import sys, vantage
loop = iter(vantage.Sequence(sys.argv[1], sys.argv[2], disparities=(0, 7)))
next(loop)
"""


def test_ctrl_c_and_exit(sequence):
    folders = [sequence / "left", sequence / "right"]
    process = subprocess.Popen([sys.executable, "-c", SCRIPT, *folders], stdout=subprocess.PIPE,
                               text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.3)
    start = time.monotonic()
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=60)
    assert output == "interrupted\n" and process.returncode == 0
    assert time.monotonic() - start < 10
    left = subprocess.run([sys.executable, "-c", LEAVING, *folders], capture_output=True, text=True,
                          timeout=60)
    assert (left.returncode, left.stderr) == (0, "")
