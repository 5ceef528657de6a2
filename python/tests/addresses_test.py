"""Paths may be addresses: the store is the one of tests/store."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import run_program

import vantage

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "store"))
from object_server import ObjectServer  # noqa: E402


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    """Folder of six pairs."""
    folder = tmp_path_factory.mktemp("clip")
    run_program("generate", "scene", "-o", folder, "--frames", 6, "--width", 64, "--height", 48,
                "--near", 6, "--quiet")
    return folder


@pytest.fixture
def store(clip, monkeypatch):
    with ObjectServer() as server:
        server.add_folder(clip)
        for name, value in server.environment().items():
            monkeypatch.setenv(name, value)
        yield server


def test_images_are_those_of_local_files(clip, store):
    address = "s3://data/left/000000.png"
    assert np.array_equal(vantage.read_image(address), vantage.read_image(clip / "left/000000.png"))
    # Another call reads what is there by then.
    store.put("left/000000.png", (clip / "left/000003.png").read_bytes())
    image = vantage.read_image(address)
    assert np.array_equal(image, vantage.read_image(clip / "left/000003.png"))
    vantage.write_image("s3://data/out.png", image)
    assert np.array_equal(vantage.read_image("s3://data/out.png"), image)
    with pytest.raises(vantage.Error, match="s3://data/none.png: no such object"):
        vantage.read_image("s3://data/none.png")


def test_a_sequence_is_of_one_version(clip, store):
    frames = {"left": "s3://data/left/", "right": "s3://data/right/", "disparities": (0, 9)}
    assert len(list(vantage.Sequence(**frames))) == 6
    store.faults.replace_after = ("left/000000.png", 1, "left/000005.png", b"another")
    with pytest.raises(vantage.Error, match="left/000005.png: has changed"):
        list(vantage.Sequence(**frames))


def test_silence_is_interrupted(store):
    """In a process of its own, whose main thread takes the signal."""
    store.faults.silent = "left"
    script = "import vantage; vantage.read_image('s3://data/left/000001.png')"
    process = subprocess.Popen([sys.executable, "-c", script], stderr=subprocess.PIPE, text=True)
    while not store.requests:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    assert "KeyboardInterrupt" in process.communicate(timeout=10)[1]
