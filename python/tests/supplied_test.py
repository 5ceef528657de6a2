"""Sequences of pairs that an iterable supplies: cameras, queues, generators."""

import gc
import itertools
import queue
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import vantage
from conftest import run_program, same

OPTIONS = {"disparities": (0, 7)}


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """Folders left and right of six pairs, 128x96."""
    folder = tmp_path_factory.mktemp("film")
    run_program("generate", "scene", "-o", folder, "--frames", 6, "--width", 128, "--height", 96,
                "--quiet")
    return folder


@pytest.fixture(scope="module")
def images(film):
    return [tuple(vantage.read_image(film / side / f"{frame:06}.png")
                  for side in ["left", "right"]) for frame in range(6)]


@pytest.mark.parametrize("options", [
    {}, {"temporal_prior": 1, "chunk_frames": 4, "save": "disparity,right_disparity,confidence"},
    {"reuse": "frame", "preset": "realtime"}, {"view": 0.5, "save": ["views", "stereo"]},
    {"calibration": "calib.txt", "in_flight": 1}, {"reference": "right", "threads": 1},
], ids=str)
def test_frames_are_those_of_the_files(film, images, options):
    if "calibration" in options:
        options = {**options, "calibration": film / options["calibration"]}
    expected = list(vantage.Sequence(film / "left", film / "right", **OPTIONS, **options))
    frames = vantage.Sequence(pairs=(pair for pair in images), **OPTIONS, **options)
    found = list(frames)
    assert [frame.index for frame in found] == list(range(6)) and frames.skipped == []
    for frame, other in zip(found, expected):
        assert same(frame.disparity, other.disparity) and same(frame.left, other.left)
        assert frame.name == f"pair {frame.index}" and frame.share_reused == other.share_reused
        for name in ["views", "holes", "sources"]:
            assert all(map(same, getattr(frame, name), getattr(other, name)))
        assert (frame.stereo is None) == (other.stereo is None)
        if "calibration" in options:
            assert same(frame.result.depth(), other.result.depth())
        if "save" in options and "views" not in options["save"]:
            assert same(frame.result.confidence, other.result.confidence)


def test_kinds_of_iterables(film, images):
    whole = [frame.disparity for frame in vantage.Sequence(pairs=images, **OPTIONS)]
    paths = [(film / "left" / f"{frame:06}.png", str(film / "right" / f"{frame:06}.png"))
             for frame in range(6)]
    lefts, rights = map(list, zip(*images))
    mirrored = [(left[:, :, ::-1], right[:, :, ::-1]) for left, right in images]
    for given in [{"pairs": paths}, {"left": lefts, "right": rights},
                  {"pairs": mirrored, "bgr": True}]:
        frames = vantage.Sequence(**given, **OPTIONS)
        assert len(frames) == 6 and "6 frames" in repr(frames)
        for _ in range(2):  # from the start each time
            found = list(frames)
            assert all(map(same, [frame.disparity for frame in found], whole)), list(given)
    assert same(found[0].left, np.ascontiguousarray(mirrored[0][0]))
    endless = vantage.Sequence(pairs=itertools.cycle(images), **OPTIONS)
    assert endless and "unknown" in repr(endless)
    with pytest.raises(TypeError, match="len"):
        len(endless)
    assert [frame.index for frame in itertools.islice(endless, 20)] == list(range(20))
    assert list(vantage.Sequence(pairs=[])) == [] and not vantage.Sequence(pairs=[])
    assert list(vantage.Sequence(pairs=iter(()))) == []


def test_the_range_and_rows_are_those_of_the_first_pair(images):
    first, second = itertools.islice(vantage.Sequence(pairs=iter(images)), 2)
    assert first.result.disparities == second.result.disparities
    alone = next(iter(vantage.Sequence(pairs=images[:1])))
    assert alone.result.disparities == first.result.disparities
    assert same(alone.disparity, first.disparity)


def test_a_result_comes_before_the_next_pair(images):
    """Who supplies pairs waits for the result of each; with one thread, too."""
    def answer(done):
        yield images[0]
        for frame in range(1, 4):
            assert done.get(timeout=60) == frame - 1
            yield images[frame]

    for threads in [1, 2]:
        done = queue.Queue()
        for frame in vantage.Sequence(pairs=answer(done), **OPTIONS, threads=threads):
            done.put(frame.index)
        assert frame.index == 3


def test_the_iterable_may_compute_with_the_same_threads(images):
    matcher = vantage.Matcher("realtime", threads=1, **OPTIONS)

    def computing():
        for left, right in images:
            matcher.compute(left, right)
            yield left, right

    assert len(list(vantage.Sequence(pairs=computing(), threads=1, **OPTIONS))) == 6


def test_pairs_are_pulled_as_they_are_needed(images):
    pulled = []

    def counting():
        for number in itertools.count():
            pulled.append(number)
            yield images[number % 6]

    frames = vantage.Sequence(pairs=counting(), in_flight=2, **OPTIONS)
    assert pulled == []
    for frame in itertools.islice(frames, 10):
        # In work or ready, waiting, and in the hand of the thread.
        assert len(pulled) <= frame.index + 1 + 2 + 2 + 1
    assert len(pulled) <= 16


def test_exceptions_reach_the_loop_after_the_frames_before(images):
    def failing(error):
        yield from images[:3]
        raise error

    for error in [ZeroDivisionError("lens cap"), KeyboardInterrupt(), vantage.Error("camera")]:
        seen = []
        with pytest.raises(type(error)) as problem:
            for frame in vantage.Sequence(pairs=failing(error), **OPTIONS):
                seen.append(frame.index)
        assert problem.value is error and seen == [0, 1, 2]
    with pytest.raises(ZeroDivisionError):
        next(iter(vantage.Sequence(pairs=(1 / 0 for _ in range(3)))))


@pytest.mark.parametrize("bad, message", [
    (lambda pair: pair[0], "pair 1 is of type ndarray, expected"),
    (lambda pair: (pair[0], None), "right of pair 1"),
    (lambda pair: (pair[0], pair[1][1:]), "left of pair 1 is 128x96 but right is 128x95"),
    (lambda pair: (pair[0][1:], pair[1][1:]), r"frame 1 \(pair 1\).*128x95, expected 128x96"),
    (lambda pair: (pair[0].astype(np.int64), pair[1]), "left of pair 1.*int64"),
])
def test_bad_pairs(images, bad, message):
    seen = []
    with pytest.raises((TypeError, vantage.Error), match=message) as problem:
        for frame in vantage.Sequence(pairs=iter([images[0], bad(images[1])]), **OPTIONS):
            seen.append(frame.index)
    assert seen == [0] and len(str(problem.value)) < 300 and "\n" not in str(problem.value)


@pytest.mark.parametrize("given, message", [
    ({"pairs": [], "left": "left"}, "pairs and left are given"),
    ({"pairs": 3}, "pairs is of type int, expected"),
    ({"left": np.zeros((9, 9)), "right": "right"}, "left is of type ndarray, expected"),
    ({"left": [np.zeros((9, 9))], "right": "right"}, "one for left and one for right"),
    ({"left": [np.zeros((999, 999))], "right": []}, "left has 1 images but right 0"),
    ({"pairs": [], "frames": slice(3)}, "itertools.islice"),
    ({"pairs": [], "every": 2}, "every"),
    ({"pairs": [], "packing": "sbsl"}, "packing"),
    ({"pairs": [], "search_range": "shot"}, "shot"),
    ({"pairs": [], "live": True, "in_flight": 2}, "in-flight cannot be used with --live"),
])
def test_bad_arguments(given, message):
    with pytest.raises((TypeError, vantage.Error), match=message) as problem:
        vantage.Sequence(**given)
    assert len(str(problem.value)) < 300


def test_live_takes_the_newest_pair(images, film):
    taken = threading.Event()

    def camera():
        yield images[0]
        taken.wait(60)  # the first result
        yield from images[1:]

    seen = []
    frames = vantage.Sequence(pairs=camera(), live=True, **OPTIONS)
    for frame in frames:
        seen.append(frame.index)
        assert frame.name == f"pair {frame.index}"
        assert same(frame.left, images[frame.index][0])
        taken.set()
    assert seen[0] == 0 and seen[-1] == 5 and seen == sorted(set(seen))
    assert frames.dropped == 6 - len(seen)
    with pytest.raises(vantage.UsageError, match="live"):
        vantage.Sequence(film / "left", film / "right", live=True)


def pullers():
    return [thread for thread in threading.enumerate() if thread.name == "vantage pairs"]


def test_threads_end_with_the_loop(images):
    closed = []

    def camera():
        try:
            yield from itertools.cycle(images)
        finally:
            closed.append(True)

    for live in [False, True]:
        for _ in vantage.Sequence(pairs=camera(), live=live, **OPTIONS):
            break
        gc.collect()
        assert pullers() == [] and closed.pop()
    with pytest.raises(ZeroDivisionError):
        for _ in vantage.Sequence(pairs=camera(), **OPTIONS):
            1 / 0
    gc.collect()
    assert pullers() == [] and closed.pop()
    # An iterable that never answers again does not keep the loop.
    silent = queue.Queue()
    silent.put(images[0])
    start = time.monotonic()
    for _ in vantage.Sequence(pairs=iter(silent.get, None), **OPTIONS):
        break
    assert time.monotonic() - start < 30
    silent.put(None)


SCRIPT = """
import queue, sys, vantage
pair = tuple(vantage.read_image(path) for path in sys.argv[1:3])
source = queue.Queue()
if sys.argv[3] == "one":
    source.put(pair)
print("ready", flush=True)
try:
    for frame in vantage.Sequence(pairs=iter(source.get, None), disparities=(0, 7)):
        print("frame", flush=True)
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.parametrize("pairs", ["none", "one"])
def test_ctrl_c_ends_the_wait_for_a_pair(film, pairs):
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, film / "left/000000.png", film / "right/000000.png", pairs],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    for line in ["ready", "frame"][:1 if pairs == "none" else 2]:
        assert process.stdout.readline() == line + "\n"
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=60)
    assert (output, process.returncode, errors) == ("interrupted\n", 0, "")
