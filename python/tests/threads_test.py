"""Threads of Python share those of the engine; Ctrl-C ends a call."""

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import cv2
import numpy as np
import pytest
from conftest import same, unrectified_pair

import vantage


def test_calls_at_a_time_share_the_threads(pair):
    matcher = vantage.Matcher(disparities=(0, 15), threads=2)
    assert matcher.threads == 2
    expected = matcher.compute(*pair).disparity
    before = len(os.listdir("/proc/self/task"))
    with ThreadPoolExecutor(6) as pool:
        maps = list(pool.map(lambda _: matcher.compute(*pair).disparity, range(24)))
        # The six threads of Python and, at most, the pool of the engine.
        assert len(os.listdir("/proc/self/task")) <= before + 6 + 2
    assert all(same(map_px, expected) for map_px in maps)


def test_far_more_threads_than_processors_are_told_and_not_made():
    processors = vantage.Matcher(disparities=(0, 15)).threads
    with pytest.warns(UserWarning, match=f"1024 for {processors} processors?: {16 * processors} are"):
        assert vantage.Matcher(disparities=(0, 15), threads=1024).threads == 16 * processors


def test_one_result_in_several_threads(pair):
    matcher = vantage.Matcher(disparities=(0, 15))
    expected = matcher.compute(*pair, right_disparity=True, confidence=True)
    for _ in range(5):
        result = matcher.compute(*pair)
        names = ["right_disparity", "confidence"] * 4
        with ThreadPoolExecutor(8) as pool:
            maps = list(pool.map(lambda name: getattr(result, name), names))
        assert all(same(map_px, getattr(expected, name)) for map_px, name in zip(maps, names))


def test_other_threads_run_meanwhile():
    matcher = vantage.Matcher(disparities=(0, 255), threads=1)
    left = np.random.default_rng(1).integers(0, 256, (480, 640), np.uint8)
    done = threading.Event()

    def compute():
        matcher.compute(left, left)
        done.set()

    thread = threading.Thread(target=compute)
    thread.start()
    steps = 0
    while not done.is_set():
        time.sleep(0.001)
        steps += 1
    thread.join()
    assert steps > 5


SCRIPT = """
import sys, numpy as np, vantage
image = np.random.default_rng(1).integers(0, 256, (800, 1200, 3), np.uint8)
slow = vantage.Matcher(method="diffusion", disparities=(0, 255), iterations=2000)
quick = vantage.Matcher("realtime", (0, 15))
before = quick.compute(image, image).disparity.copy()
print("ready", flush=True)
try:
    slow.compute(image, image)
except KeyboardInterrupt:
    print("interrupted", np.array_equal(quick.compute(image, image).disparity, before, True))
"""


def test_ctrl_c_interrupts():
    process = subprocess.Popen([sys.executable, "-c", SCRIPT], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.3)
    start = time.monotonic()
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=60)
    assert output == "interrupted True\n"
    assert time.monotonic() - start < 10


DAEMONS = """
import sys, threading, time, vantage
left, right = (vantage.read_image(f"{sys.argv[1]}/{side}.png") for side in ["left", "right"])
matcher = vantage.Matcher("realtime", (0, 15))
pairs = {"left": sys.argv[1] + "/left.png", "right": sys.argv[1] + "/right.png"}
def compute():
    while True:
        matcher.compute(left, right)
def loop():
    while True:
        for frame in vantage.Sequence(**pairs, disparities=(0, 15)):
            frame.result.right_disparity
for work in [compute, loop, compute, loop]:
    threading.Thread(target=work, daemon=True).start()
time.sleep(0.2)
"""


def test_daemon_threads_end_with_the_process(scene):
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", DAEMONS, scene], capture_output=True,
                              text=True, timeout=60)
        assert (done.returncode, done.stderr) == (0, "")


WAITING = """
import os, sys, threading, numpy as np, vantage
image = np.random.default_rng(1).integers(0, 256, (800, 1200, 3), np.uint8)
slow = vantage.Matcher(method="diffusion", disparities=(0, 255), iterations=2000, threads=1)
quick = vantage.Matcher("realtime", (0, 15), threads=1)
threading.Thread(target=slow.compute, args=(image, image)).start()
print("ready", flush=True)
try:
    while True:
        quick.compute(image, image)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    os._exit(0)  # the other thread has a long way to go
"""


def test_ctrl_c_ends_waiting_for_a_thread():
    process = subprocess.Popen([sys.executable, "-c", WAITING], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    try:
        assert process.communicate(timeout=30)[0] == "interrupted\n"
    finally:
        process.kill()


def test_signals_interrupt_estimating_cameras():
    left, right = unrectified_pair()

    def rectify_seconds():
        start = time.process_time()
        try:
            vantage.rectify(left, right)
        except InterruptedError:
            pass
        return time.process_time() - start

    def interrupt(*_):
        raise InterruptedError

    whole = rectify_seconds()
    before = signal.signal(signal.SIGPROF, interrupt)
    try:
        for share in [0.1, 0.5]:  # in features, in cameras
            signal.setitimer(signal.ITIMER_PROF, share * whole)
            assert rectify_seconds() < (share + 0.35) * whole
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def test_cv2_keeps_its_settings(scene):
    cv2.setNumThreads(3)
    vantage.read_image(scene / "left.png")
    vantage.rectify(*(vantage.read_image(scene / f"{side}.png") for side in ["left", "right"]),
                    scene / "calib.txt")
    assert cv2.getNumThreads() == 3


def test_a_child_forked_while_another_thread_computes_says_so():
    matcher = vantage.Matcher(disparities=(0, 255), threads=1)
    left = np.random.default_rng(1).integers(0, 256, (480, 640), np.uint8)
    thread = threading.Thread(target=lambda: [matcher.compute(left, left) for _ in range(3)])
    thread.start()
    time.sleep(0.05)
    child = os.fork()
    if child == 0:
        try:
            signal.alarm(20)
            matcher.compute(left, left)
            os._exit(1)
        except vantage.Error as problem:
            os._exit(0 if "forked while another thread computed" in str(problem) else 2)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    thread.join()
    assert same(matcher.compute(left, left).disparity, matcher.compute(left, left).disparity)


def test_a_child_forked_before_anything_computes_works():
    left = np.random.default_rng(1).integers(0, 256, (48, 64), np.uint8)
    child = os.fork()
    if child == 0:
        signal.alarm(20)
        vantage.Matcher(disparities=(0, 7), threads=3).compute(left, left)
        os._exit(0)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
