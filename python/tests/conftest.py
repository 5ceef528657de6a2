"""Scenes for the tests, made by the program, and the program itself."""

import os
import subprocess

import cv2
import numpy as np
import pytest

import vantage

PROGRAM = os.environ["VANTAGE_BINARY"]


def run_program(*arguments):
    """Runs the program; its stderr if it fails."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done


def complaint_of_program(*arguments):
    """The text of its error, without the name of the command."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode != 0
    return done.stderr.strip().splitlines()[-1]


@pytest.fixture(scope="session")
def scene(tmp_path_factory):
    """Folder of a pair in colour, with its truth and calibration: 160x120, disparities 2 to 10."""
    folder = tmp_path_factory.mktemp("scene")
    run_program("generate", "scene", "-o", folder, "--width", 160, "--height", 120, "--quiet")
    return folder


@pytest.fixture(scope="session")
def pair(scene):
    return vantage.read_image(scene / "left.png"), vantage.read_image(scene / "right.png")


@pytest.fixture(scope="session")
def truth(scene):
    return vantage.read_disparity(scene / "left-disparity.pfm")


def same(first, second):
    """Equal bit for bit, NaN included."""
    return first.dtype == second.dtype and np.array_equal(first, second, equal_nan=True)


def unrectified_pair():
    """Grey, 160x120: steps at disparities 4 to 20, the right image two rows lower."""
    rows, columns = np.indices((120, 160), np.float32)
    texture = cv2.GaussianBlur(np.random.default_rng(1).integers(0, 256, (120, 240), np.uint8),
                               (0, 0), 1)
    shift = 4 + 8 * ((columns // 60 + rows // 60) % 3)
    return (cv2.remap(texture, columns + 40 - shift / 2, rows, cv2.INTER_LINEAR),
            cv2.remap(texture, columns + 40 + shift / 2, rows + 2, cv2.INTER_LINEAR))


def words(options, prefix=""):
    """Options as the command line has them."""
    found = []
    for name, value in options.items():
        name = f"--{prefix}{name.replace('_', '-')}"
        if value is True:
            found.append(name)
        elif isinstance(value, list):
            found.append(f"{name}={','.join(map(str, value))}")
        elif isinstance(value, tuple):
            found.append(f"{name}={':'.join(map(str, value))}")
        elif value is not None:
            found.append(f"{name}={value}")
    return found
