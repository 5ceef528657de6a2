"""Photographs that are not rectified, and lists of pairs: as the program has them, byte for byte."""

import os

import numpy as np
import pytest
from conftest import run_program, same

import vantage

RIG = """%YAML:1.0
M1: [150, 0, 80, 0, 150, 60, 0, 0, 1]
D1: [-0.05, 0.01, 0.001, -0.001]
M2: [151, 0, 81, 0, 151, 60, 0, 0, 1]
D2: [-0.05, 0.01, 0.001, -0.001]
R: [1, 0, 0, 0, 0.999992, -0.004, 0, 0.004, 0.999992]
T: [-0.2, 0.002, 0.001]
"""


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    path = tmp_path_factory.mktemp("rig") / "rig.yml"
    path.write_text(RIG)
    return path


def files(scene):
    return scene / "left.png", scene / "right.png"


@pytest.mark.parametrize("on_rectified", [False, True])
def test_maps_of_photographs(scene, pair, rig, tmp_path, on_rectified):
    out = tmp_path / "m.npy", tmp_path / "r.npy", tmp_path / "c.npy"
    run_program("match", *files(scene), "--unrectified", rig, "-o", out[0], "--output-right", out[1],
                "--confidence", out[2], *["--rectified-pixels"] * on_rectified)
    matcher = vantage.Matcher(unrectified=rig, rectified_pixels=on_rectified)
    result = matcher.compute(*pair)  # the range is found in the rectified pair
    assert same(result.disparity, np.load(out[0]))
    assert same(result.right_disparity, np.load(out[1]))  # later
    assert same(result.confidence, np.load(out[2]))
    small = matcher.compute(*[image[10:, 10:] for image in pair])  # other cameras
    assert small.disparity.shape == (110, 150)
    if not on_rectified:
        for metric in [result.depth, result.depth_resolution, result.cloud, result.mesh]:
            with pytest.raises(vantage.UsageError, match="expected rectified_pixels=True"):
                metric(calibration_unit="m")


def test_points_of_rectified_pixels(scene, pair, rig, tmp_path):
    result = vantage.Matcher("balanced", (0, 15), unrectified=rig,
                             rectified_pixels=True).compute(*pair)
    rectified = vantage.rectify(*pair, rig)
    assert same(result.depth(calibration_unit="m"),
                vantage.depth(result.disparity, rectified.calibration, calibration_unit="m"))
    assert same(result.cloud(calibration_unit="m").colours,
                vantage.cloud(result.disparity, rectified.left, rectified.calibration,
                              unmatched=result.unmatched, calibration_unit="m").colours)
    with pytest.raises(vantage.Error, match="rig.yml: does not say how long its unit is"):
        result.depth()


def test_refusals_of_photographs(pair, rig):
    for options, message in [
            ({"selection": "symmetric"}, "selection is symmetric"),
            ({"disparities_y": (0, 1)}, "disparities-y is set")]:
        with pytest.raises(vantage.UsageError, match=message):
            vantage.Matcher(unrectified=rig, **options)
    with pytest.raises(vantage.UsageError, match="rectified-pixels has no effect"):
        vantage.Matcher(rectified_pixels=True)
    matcher = vantage.Matcher("balanced", (0, 15), unrectified=rig)
    with pytest.raises(vantage.UsageError, match="a calibration is of two cameras"):
        matcher.compute(*pair, more=[pair[1]], baselines=[1, 2])
    with pytest.raises(vantage.UsageError, match="posterior cannot be used"):
        matcher.compute(*pair, posterior=True)
    with pytest.raises(vantage.UsageError, match="posterior cannot be used"):
        _ = matcher.compute(*pair).posterior_mean
    with pytest.raises(vantage.UsageError, match="a volume cannot be had"):
        matcher.volume(*pair)


def test_sequences_of_photographs(scene, rig, tmp_path):
    left, right = files(scene)
    options = {"preset": "balanced", "disparities": (0, 15), "save": ["disparity", "right-disparity"]}
    for on_rectified in [False, True]:
        out = tmp_path / str(on_rectified)
        run_program("run", "--left", left, "--right", right, "--unrectified", rig, "-o", out,
                    "--preset", "balanced", "--disparities", "0:15", "--save",
                    "disparity,right-disparity", "--format", "npy",
                    *["--rectified-pixels"] * on_rectified)
        frame, = vantage.Sequence(left, right, unrectified=rig, rectified_pixels=on_rectified,
                                  calibration_unit="m", **options)
        assert same(frame.result.disparity, np.load(out / "disparity/000000.npy"))
        assert same(frame.result.right_disparity, np.load(out / "right-disparity/000000.npy"))
        if on_rectified:
            assert np.isfinite(frame.result.depth()).any()
        else:
            with pytest.raises(vantage.UsageError, match="expected rectified_pixels=True"):
                frame.result.depth()
        with pytest.raises(vantage.Error, match="confidence depends on more than the images"):
            _ = frame.result.confidence
    for more, message in [({"calibration": rig}, "calibration and unrectified are both given"),
                          ({"temporal_prior": 1}, "temporal-prior cannot be used with unrectified"),
                          ({"view": 0.5, "save": ["views"]}, "expected rectified-pixels too")]:
        with pytest.raises(vantage.UsageError, match=message):
            vantage.Sequence(left, right, unrectified=rig, **{**options, **more})
    with pytest.raises(vantage.UsageError, match="rectified-pixels has no effect"):
        vantage.Sequence(left, right, rectified_pixels=True)


def test_lists_with_cameras_and_ranges(scene, rig, tmp_path):
    left, right = files(scene)
    cameras = os.path.relpath(rig, tmp_path)
    (tmp_path / "list.csv").write_text(
        "left,right,name,calibration,min-disparity,max-disparity\n"
        f"{left},{right},turned,{cameras},0,9\n"
        f"{left},{right},plain,{scene / 'calib.txt'},2,12\n")
    run_program("run", "--pairs", tmp_path / "list.csv", "-o", tmp_path / "out", "--save",
                "disparity,depth,preview", "--format", "npy", "--depth-format", "npy",
                "--calibration-unit", "m", "--preset", "balanced")
    sequence = vantage.Sequence(pairs=tmp_path / "list.csv", preset="balanced", calibration_unit="m")
    for frame, name, disparities in zip(sequence, ["turned", "plain"], [(0, 9), (2, 12)],
                                        strict=True):
        result = frame.result
        assert result.disparities == disparities
        for array, kind in [(result.disparity, "disparity"), (result.depth(), "depth")]:
            assert same(array, np.load(tmp_path / "out" / kind / f"{name}.npy"))
        assert same(result.preview(), vantage.read_image(tmp_path / f"out/preview/{name}.png"))
    # Without a unit the depths of the second alone are known.
    with pytest.raises(vantage.UsageError, match="needs --calibration|needs"):
        next(iter(vantage.Sequence(pairs=tmp_path / "list.csv", preset="balanced"))).result.depth()
    with pytest.raises(vantage.UsageError, match="a view is defined by one pair of cameras"):
        vantage.Sequence(pairs=tmp_path / "list.csv", view=0.5)
