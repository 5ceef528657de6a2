"""The maps of a pair are those of `vantage match`, byte for byte."""

import re

import cv2
import numpy as np
import pytest
from conftest import complaint_of_program, run_program, same

import vantage


def names_of(option):
    """The values of an option, from its message."""
    with pytest.raises(ValueError) as problem:
        vantage.Matcher(**{"preset": None, option: "?"})
    return re.search(r"one of (\S+)", str(problem.value)).group(1).split("|")


def choices():
    for preset in names_of("preset"):
        yield {"preset": preset}
    for method in names_of("method"):
        yield {"method": method}
    for cost in names_of("cost"):
        yield {"preset": None, "cost": cost}
    yield {"method": "ssd", "disparities_y": (-1, 1)}
    yield {"reference": "right", "fill": "none"}
    yield {"preset": "realtime", "disparities": "auto"}


@pytest.mark.parametrize("options", choices(), ids=str)
def test_same_bytes_as_the_program(scene, pair, tmp_path, options):
    options = {"disparities": (0, 15), **options}
    arguments = []
    for name, value in options.items():
        if value is not None:
            text = ":".join(map(str, value)) if isinstance(value, tuple) else str(value)
            arguments.append(f"--{name.replace('_', '-')}={text}")
    displacements = "disparities_y" in options
    output = tmp_path / ("map.flo" if displacements else "map.npy")
    files = ["-o", output]
    if not displacements:
        files += ["--confidence", tmp_path / "confidence.npy", "--unmatched", tmp_path / "mask.png"]
        if "reference" not in options:
            files += ["--output-right", tmp_path / "right.npy"]
    run_program("match", scene / "left.png", scene / "right.png", *arguments, *files,
                "--no-tuning")
    result = vantage.Matcher(**options)(*pair)
    if displacements:
        # .flo holds where the partner is: to the left, and above.
        flow = np.frombuffer(output.read_bytes(), "<f4", offset=12).reshape(120, 160, 2)
        known = np.isfinite(result.disparity)
        assert same(-result.disparity[known], flow[..., 0][known])
        assert same(-result.disparity_y[known], flow[..., 1][known])
        return
    assert same(result.disparity, np.load(output))
    assert same(result.confidence, np.load(tmp_path / "confidence.npy"))
    assert np.array_equal(result.unmatched, vantage.read_image(tmp_path / "mask.png") == 255)
    if "reference" not in options:
        assert same(result.right_disparity, np.load(tmp_path / "right.npy"))
        assert result.disparity_y is None


def test_near_the_truth(pair, truth):
    result = vantage.Matcher(disparities=(0, 15)).compute(*pair)
    assert np.mean(np.abs(result.disparity - truth) > 1) < 0.1
    assert result.disparities == (0, 15)
    assert 0 <= vantage.Matcher().compute(*pair).disparities[0] <= 2


def lower(image, rows):
    height, width = image.shape[:2]
    return cv2.warpAffine(image, np.float32([[1, 0, 0], [0, 1, rows]]), (width, height),
                          flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)


def test_rows_that_are_off_are_corrected_with_a_warning(pair):
    left, right = pair
    moved = lower(right, 1.5)
    with pytest.warns(UserWarning, match="rows: right image 1.* px lower.*; corrected"):
        result = vantage.Matcher("realtime", (0, 15)).compute(left, moved)
    assert any("corrected" in text for text in result.remarks)
    level = vantage.Matcher("realtime", (0, 15)).compute(left, right)
    inner = np.s_[6:-6, 20:-6]
    as_is = vantage.Matcher("realtime", (0, 15), rows="as-is").compute(left, moved)

    def off(given, expected):
        return np.mean(np.abs(given[inner] - expected[inner]) > 0.5)

    assert off(result.disparity, level.disparity) < 0.06
    assert off(result.disparity, level.disparity) < off(as_is.disparity, level.disparity) / 2
    # Asked for later, on the pixels of the given image.
    given_rows = lower(level.right_disparity, 1.5)
    assert off(result.right_disparity, given_rows) < off(as_is.right_disparity, given_rows) / 2
    with pytest.warns(UserWarning, match="rows: .*; corrected"):
        view = vantage.synthesize(left, moved, 0.5, preset="realtime", disparities=(0, 15))
    true = vantage.synthesize(left, right, 0.5, preset="realtime", disparities=(0, 15))
    wrong = vantage.synthesize(left, moved, 0.5, preset="realtime", disparities=(0, 15),
                               rows="as-is")
    assert cv2.PSNR(view[8:-8], true[8:-8]) > cv2.PSNR(wrong[8:-8], true[8:-8]) + 3


def test_a_map_that_measures_nothing_warns_once(pair):
    black = np.zeros((60, 80), np.uint8)
    matcher = vantage.Matcher(disparities=(0, 15))
    with pytest.warns(UserWarning, match="hardly a measurement") as caught:
        results = [matcher.compute(black, black + 1) for _ in range(2)]
    assert len(caught) == 1 and caught[0].filename == __file__
    assert results[1].reliable_share < 0.1 and results[1].confidence.max() < 0.5
    good = matcher.compute(*pair)
    assert good.reliable_share > 0.5 and good.confidence.min() >= 0
    assert good.matched_share + good.filled_share == pytest.approx(1)
    assert good.matched_share == pytest.approx(1 - good.unmatched.mean())


def test_what_is_computed_later_is_the_same(pair):
    matcher = vantage.Matcher(disparities=(0, 15))
    at_once = matcher.compute(*pair, right_disparity=True, confidence=True)
    later = matcher.compute(*pair)
    for name in ["right_disparity", "confidence", "right_unmatched", "disparity", "unmatched"]:
        assert same(getattr(later, name), getattr(at_once, name))
    assert later.disparity.dtype == np.float32 and later.unmatched.dtype == bool


def test_images_that_changed_are_refused(pair):
    left, right = pair[0].copy(), pair[1]
    result = vantage.Matcher(disparities=(0, 15)).compute(left, right)
    left[60, 80, 1] ^= 1
    with pytest.raises(vantage.Error, match="images have changed since compute"):
        result.right_disparity
    assert result.disparity.shape == (120, 160)


def test_preview_is_that_of_the_program(scene, pair, tmp_path):
    run_program("match", scene / "left.png", scene / "right.png", "--disparities", "0:15", "-o",
                tmp_path / "map.npy", "--preview", tmp_path / "preview.png")
    result = vantage.Matcher(disparities=(0, 15))(*pair)
    preview = vantage.read_image(tmp_path / "preview.png")
    assert same(result.preview(), preview)
    assert same(vantage.colours(result.disparity, (-0.5, 15.5)), preview)


@pytest.mark.parametrize("option, value", [
    ("window", 4), ("preset", "best"), ("disparities", "15:0"), ("levels", 99), ("fill", 3)])
def test_messages_are_those_of_the_program(scene, tmp_path, option, value):
    with pytest.raises(ValueError) as problem:
        vantage.Matcher(**{"preset": None, option: value})
    said = complaint_of_program("match", scene / "left.png", scene / "right.png", "-o",
                                tmp_path / "map.npy", f"--{option}={value}")
    expected = str(problem.value).split(", expected")[-1]
    assert expected in said
    assert isinstance(problem.value, vantage.Error)
    assert "\n" not in str(problem.value)


def test_options_are_checked():
    with pytest.raises(ValueError, match="unknown option 'cross_chek'.*did you mean cross-check"):
        vantage.Matcher(cross_chek=2)
    with pytest.raises(ValueError, match="preset is 3"):
        vantage.Matcher(preset=3)
    with pytest.raises(ValueError, match="method and preset are both set"):
        vantage.Matcher("balanced", method="ssd")
    with pytest.raises(ValueError, match="window is of type object"):
        vantage.Matcher(window=object())
    with pytest.raises(ValueError, match="unknown option 'report'"):
        vantage.Matcher(report="file.json")
    assert vantage.Matcher(fill="none").options["fill"] == "none"
    for options in [{}, {"preset": "balanced"}, {"method": "ssd"}, {"aggregate": "none"},
                    {"disparities_y": (0, 1), "disparities": (0, 3)}]:
        options = vantage.Matcher(**options).options
        assert vantage.Matcher(**options).options == options


def test_no_range(pair):
    with pytest.raises(vantage.Error, match="no disparity range can be estimated"):
        vantage.Matcher().compute(np.zeros_like(pair[0]), np.zeros_like(pair[1]))


def test_results_never_share_memory_that_is_in_use(pair):
    """Memory of results that are gone is used again; arrays keep theirs."""
    left, right = pair
    matcher = vantage.Matcher(disparities=(0, 15))
    small = left[:50, :70], right[:50, :70]
    expected = [vantage.Matcher(disparities=(0, 15)).compute(*images)
                for images in (pair, small)]
    kept = []
    for number in range(6):
        which = number % 2
        result = matcher.compute(*(pair, small)[which], confidence=number == 3)
        if number == 2:
            result.right_disparity  # as a later one must not have it
        kept.append((which, result.disparity, result.unmatched))
        if number % 3 == 0:
            kept.pop(0)
        del result
    for which, disparity, unmatched in kept:
        assert same(disparity, expected[which].disparity)
        assert same(unmatched, expected[which].unmatched)
    again = matcher.compute(left, right)
    assert same(again.right_disparity, expected[0].right_disparity)
    assert same(again.confidence, expected[0].confidence)


def test_pixels_that_show_no_scene_are_unknown(pair):
    mask = np.ones(pair[0].shape[:2], bool)
    mask[5:15, 8:20] = False
    matcher = vantage.Matcher("realtime", (0, 15))
    result = matcher.compute(*pair, mask=mask, mask_right=mask.astype(np.uint8))
    assert np.array_equal(np.isnan(result.disparity), ~mask) and result.unmatched[~mask].all()
    assert np.array_equal(np.isnan(result.right_disparity), ~mask)
    barred = [image.copy() for image in pair]
    for image in barred:
        image[:6] = 0
    assert np.isnan(matcher.compute(*barred).disparity[:6]).all()
    assert not np.isnan(matcher.compute(*barred, mask="none").disparity).any()
    with pytest.raises(vantage.Error, match="the mask of the left image is"):
        matcher.compute(*pair, mask=mask[:5])


def test_a_region_and_a_scale(pair):
    known = ~np.isnan(vantage.Matcher("balanced", (0, 15), roi=(4, 6, 20, 11)).compute(*pair).disparity)
    assert known.sum() == 220 and known[6:17, 4:24].all()
    assert vantage.Matcher("balanced", (0, 15), scale=0.5).compute(*pair).disparity.shape == known.shape
