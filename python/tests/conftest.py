"""Scenes for the tests, made by the program, and the program itself."""

import os
import subprocess

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


@pytest.fixture(scope="session")
def sequence(tmp_path_factory):
    """Folder of four pairs: left/000000.png …"""
    folder = tmp_path_factory.mktemp("sequence")
    run_program("generate", "scene", "-o", folder, "--frames", 4, "--width", 96, "--height", 64,
                "--quiet")
    return folder


def same(first, second):
    """Equal bit for bit, NaN included."""
    return first.dtype == second.dtype and np.array_equal(first, second, equal_nan=True)
