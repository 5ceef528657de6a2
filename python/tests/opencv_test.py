"""vantage.opencv has the interface of cv2.StereoSGBM."""

import inspect
import warnings

import cv2
import numpy as np
import pytest

import vantage
import vantage.opencv


@pytest.fixture(scope="module")
def bgr_pair(scene):
    return [cv2.imread(str(scene / f"{side}.png")) for side in ["left", "right"]]


def test_result_is_that_of_opencv_in_form(bgr_pair):
    arguments = (-3, 16)
    ours = vantage.opencv.StereoVantage_create(*arguments)
    fixed = ours.compute(*bgr_pair)
    reference = cv2.StereoSGBM_create(*arguments, 5, 8, 32).compute(*bgr_pair)
    assert fixed.dtype == reference.dtype and fixed.shape == reference.shape
    unknown = (-3 - 1) * 16
    assert unknown in fixed and unknown in reference
    both = (fixed != unknown) & (reference != unknown)
    assert np.median(np.abs(fixed[both].astype(int) - reference[both])) <= 8
    map_px = vantage.Matcher(disparities=(-3, 12), fill="none").compute(*bgr_pair, bgr=True)
    known = np.isfinite(map_px.disparity)
    assert np.array_equal(known, fixed != unknown)
    assert np.allclose(fixed[known] / 16, map_px.disparity[known], atol=1 / 32)
    for stereo in [ours, cv2.StereoSGBM_create(*arguments)]:
        into = np.zeros_like(fixed)
        assert stereo.compute(*bgr_pair, into) is into and into.any()
        for other in [np.zeros((3, 3), np.int16), np.zeros(fixed.shape, np.float32)]:
            made = stereo.compute(*bgr_pair, other)
            assert made.dtype == np.int16 and made.shape == fixed.shape and not other.any()


def parameters():
    signature = inspect.signature(vantage.opencv.StereoVantage.__init__).parameters.values()
    return [one for one in signature
            if one.name != "self" and one.kind is one.POSITIONAL_OR_KEYWORD]


def get(stereo, name):
    return getattr(stereo, f"get{name[0].upper()}{name[1:]}")()


def put(stereo, name, value):
    getattr(stereo, f"set{name[0].upper()}{name[1:]}")(value)


@pytest.mark.filterwarnings("ignore:StereoVantage")
def test_parameters_are_those_of_opencv():
    documented = cv2.StereoSGBM_create.__doc__.split("(")[1].split(")")[0]
    assert [one.name for one in parameters()] == documented.replace("[", "").replace(
        "]", "").replace(" ", "").strip(",").split(",")
    theirs = cv2.StereoSGBM_create()
    ours = vantage.opencv.StereoVantage_create()
    assert {name for name in dir(theirs) if name[:3] in ["get", "set"]} - {"getDefaultName"} == {
        name for name in dir(ours) if name[:3] in ["get", "set"]}
    for number, one in enumerate(parameters()):
        assert get(ours, one.name) == one.default == get(theirs, one.name), one.name
        for stereo in [ours, theirs]:
            put(stereo, one.name, np.int64(number + 1))
            assert get(stereo, one.name) == number + 1
    values = range(3, 14)
    ours, theirs = (create(*values) for create in [vantage.opencv.StereoVantage.create,
                                                   cv2.StereoSGBM.create])
    assert [get(ours, one.name) for one in parameters()] == list(values)
    assert [get(theirs, one.name) for one in parameters()] == list(values)


def test_parameters_with_a_counterpart_act(bgr_pair):
    plain = vantage.opencv.StereoVantage_create()
    expected = {"disp12MaxDiff": (2, {"cross_check": 3}),
                "speckleWindowSize": (5000, {"speckle_size": 5001})}
    for name, (value, options) in expected.items():
        stereo = vantage.opencv.StereoVantage_create()
        put(stereo, name, value)
        found = stereo.compute(*bgr_pair)
        assert np.array_equal(
            found, vantage.opencv.StereoVantage_create(**options).compute(*bgr_pair))
        assert not np.array_equal(found, plain.compute(*bgr_pair)), name
        with pytest.raises(ValueError, match=f"{name} and {list(options)[0]} are both given"):
            vantage.opencv.StereoVantage_create(**{name: value}, **options)
    plain.setMinDisparity(2)
    plain.setNumDisparities(8)
    found = plain.compute(*bgr_pair)
    assert found.min() == 16 and found.max() <= 9 * 16 + 8


def test_parameters_without_effect_warn_once():
    with pytest.warns(UserWarning, match="without effect: blockSize, P1, P2, mode; ") as caught:
        stereo = vantage.opencv.StereoVantage_create(0, 16, 5, 8, 32, mode=2)
    assert len(caught) == 1 and caught[0].filename == __file__
    with pytest.warns(UserWarning, match="without effect: uniquenessRatio; ") as caught:
        for _ in range(3):
            stereo.setUniquenessRatio(10)
        stereo.setP1(9)
    assert len(caught) == 1 and caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        vantage.opencv.StereoVantage_create(1, 32, 3, 0, 0, 1, 0, 0, 100, 1, 0)


@pytest.mark.parametrize("name, value, error, message", [
    ("numDisparities", 0, ValueError, "numDisparities is 0, expected at least 1"),
    ("minDisparity", 1990, ValueError, "minDisparity is 1990"),
    ("minDisparity", 1.5, TypeError, "minDisparity is 1.5, expected a whole number"),
    ("blockSize", None, TypeError, "blockSize is None"),
])
def test_refused_values_are_not_kept(bgr_pair, name, value, error, message):
    stereo = vantage.opencv.StereoVantage_create(0, 32)
    expected = stereo.compute(*bgr_pair), get(stereo, name)
    with pytest.raises(error, match=message) as problem:
        put(stereo, name, value)
    assert "\n" not in str(problem.value)
    assert get(stereo, name) == expected[1]
    assert np.array_equal(stereo.compute(*bgr_pair), expected[0])
    with pytest.raises(error, match=message):
        vantage.opencv.StereoVantage_create(**{name: value})
