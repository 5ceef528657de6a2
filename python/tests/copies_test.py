"""What is made of options and numbers can be copied and sent to other processes."""

import copy
import multiprocessing
import pickle

import numpy as np
import pytest
from conftest import same, unrectified_pair

import vantage
import vantage.opencv


def copies(thing):
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        yield pickle.loads(pickle.dumps(thing, protocol))
    yield copy.copy(thing)
    yield copy.deepcopy(thing)


def test_matchers(pair):
    matcher = vantage.Matcher("balanced", (0, 15), fill="none", threads=2)
    expected = matcher(*pair).disparity
    for one in copies(matcher):
        assert one.options == matcher.options and one.threads == 2 and repr(one) == repr(matcher)
        assert same(one(*pair).disparity, expected)


def test_matchers_of_photographs_that_are_not_rectified():
    left, right = unrectified_pair()
    cameras = vantage.Calibration(np.diag([160.0, 160, 1]) + [[0, 0, 80], [0, 0, 60], [0, 0, 0]],
                                  T=[-0.1, 0.002, 0])
    matcher = vantage.Matcher("balanced", (0, 31), unrectified=cameras, rectified_pixels=True)
    expected = matcher(left, right).disparity
    for one in copies(matcher):
        assert same(one(left, right).disparity, expected)


@pytest.mark.filterwarnings("error")
def test_stereo_vantage(pair):
    stereo = vantage.opencv.StereoVantage_create(-2, 16, speckleWindowSize=200, preset="balanced")
    with pytest.warns(UserWarning, match="without effect: P1"):
        stereo.setP1(7)
    expected = stereo.compute(*pair)
    for one in copies(stereo):
        assert one.getP1() == 7 and one.getMinDisparity() == -2
        assert np.array_equal(one.compute(*pair), expected)
        one.setMinDisparity(0)
        assert stereo.getMinDisparity() == -2


def calibrations(scene):
    yield vantage.Calibration.load(scene / "calib.txt")
    yield vantage.Calibration([[150, 0.5, 80], [0, 151, 60], [0, 0, 1]], [-0.1, 0.02, 0, 0],
                              [[149, 0, 81], [0, 150, 60], [0, 0, 1]], [0.1, 0, 0, 0, 0.2],
                              np.eye(3), [-0.1, 0.01, 0], image_size=(160, 120),
                              metres_per_unit=0.5)
    yield vantage.Calibration.from_focal_length(720, 0.12, principal_point_px=(70, 60))
    estimated = vantage.rectify(*unrectified_pair())
    yield estimated.cameras
    yield estimated.calibration


def test_calibrations(scene):
    for calibration in calibrations(scene):
        for one in copies(calibration):
            for name in ["K1", "K2", "D1", "D2", "R", "T", "image_size", "rectified", "baseline",
                         "doffs", "metres_per_unit"]:
                assert np.array_equal(getattr(one, name), getattr(calibration, name)), name
    # That it has no scale is kept, too.
    for one in copies(calibration):
        with pytest.raises(vantage.Error, match="scale"):
            vantage.depth(np.ones((120, 160), np.float32), one, calibration_unit="m")


def test_points(scene, pair, tmp_path):
    result = vantage.Matcher("realtime", (0, 15))(*pair)
    calibration = vantage.Calibration.load(scene / "calib.txt")
    for made, write in [(result.cloud(calibration, cloud_confidence=True), vantage.write_cloud),
                        (result.mesh(calibration), vantage.write_mesh)]:
        write(tmp_path / "made.ply", made)
        for one in copies(made):
            write(tmp_path / "copy.ply", one)
            assert (tmp_path / "copy.ply").read_bytes() == (tmp_path / "made.ply").read_bytes()


def test_another_process(pair):
    matcher = vantage.Matcher("realtime", (0, 15), search_size="full")
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        volume = pool.apply(matcher.volume, pair, {"rows": (3, 5)})
    assert same(volume.values, matcher.volume(*pair, rows=(3, 5)).values)
