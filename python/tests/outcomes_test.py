"""What `vantage match` makes beside maps of pairs: several images, volumes, p(d), the middle camera."""

import numpy as np
import pytest
from conftest import run_program, same, words

import vantage

RANGE = {"disparities": (0, 15)}


@pytest.fixture(scope="module")
def line():
    """Three images of a textured plane at disparity 6 between the first two, cameras at 0, 1, -1.5.
    """
    rng = np.random.default_rng(2)
    texture = rng.integers(0, 256, (60, 140), np.uint8)
    return [np.ascontiguousarray(texture[:, 20 + shift:110 + shift]) for shift in [0, 6, -9]]


@pytest.fixture(scope="module")
def line_files(line, tmp_path_factory):
    folder = tmp_path_factory.mktemp("line")
    for number, image in enumerate(line):
        vantage.write_image(folder / f"{number}.png", image)
    return folder, [folder / f"{number}.png" for number in range(3)]


@pytest.mark.parametrize("options", [{**RANGE}, {"disparities": "auto"},
                                     {**RANGE, "method": "bayes"}], ids=str)
def test_several_images(line, line_files, options):
    folder, files = line_files
    run_program("match", *files, "--baselines=1,-1.5", *words(options), "-o", folder / "map.npy",
                "--confidence", folder / "confidence.npy")
    result = vantage.Matcher(**options).compute(line[0], line[1], more=[line[2]],
                                                baselines=[1, -1.5])
    assert same(result.disparity, np.load(folder / "map.npy"))
    assert same(result.confidence, np.load(folder / "confidence.npy"))
    assert np.nanmedian(result.disparity) == pytest.approx(6, abs=0.25)
    with pytest.raises(vantage.Error, match="right_disparity cannot be had of several images"):
        result.right_disparity
    # A first camera on the left: disparities are negative in the image, positive as a right map.
    mirrored = vantage.Matcher(**options).compute(line[1], line[0], baselines=[-1])
    assert np.nanmedian(mirrored.disparity) == pytest.approx(6, abs=0.25)


@pytest.mark.parametrize("matcher, arguments, message", [
    ({}, {"baselines": [1]}, "baselines has 1 number, expected 2: one for each image but the first"),
    ({}, {}, "baselines has 0 numbers, expected 2"),
    ({}, {"baselines": [1, 0]}, "baseline 2 is 0"),
    ({"window_levels": 1}, {"baselines": [1, 2]}, "window_levels has no effect with several images"),
    ({"reference": "right"}, {"baselines": [1, 2]}, "reference right cannot be used"),
    ({"method": "ssd", "disparities_y": (0, 1)}, {"baselines": [1, 2]}, "disparities-y cannot be"),
    ({}, {"baselines": [1, 2], "right_disparity": True}, "right_disparity cannot be had"),
])
def test_several_images_of_bad_input(line, matcher, arguments, message):
    with pytest.raises(ValueError, match=message):
        vantage.Matcher(**RANGE, **matcher).compute(line[0], line[1], more=[line[2]], **arguments)
    with pytest.raises(vantage.Error, match=r"more\[0\] is 89x60 but left is 90x60"):
        vantage.Matcher(**RANGE).compute(line[0], line[1], more=[line[2][:, 1:]], baselines=[1, 2])


def test_cameras_one_above_the_other(pair, tmp_path):
    upper, lower = (np.ascontiguousarray(image.swapaxes(0, 1)) for image in pair)
    for name, image in [("upper.png", upper), ("lower.png", lower)]:
        vantage.write_image(tmp_path / name, image)
    run_program("match", tmp_path / "upper.png", tmp_path / "lower.png", "--vertical",
                "--disparities", "0:15", "-o", tmp_path / "map.npy", "--no-tuning")
    result = vantage.Matcher(**RANGE)(upper.swapaxes(0, 1), lower.swapaxes(0, 1))
    assert same(np.ascontiguousarray(result.disparity.T), np.load(tmp_path / "map.npy"))


@pytest.mark.parametrize("options, wanted", [
    ({"preset": "balanced"}, {}),
    ({"preset": "balanced"}, {"level": 1, "rows": (3, 20)}),
    ({"method": "ssd"}, {"kind": "costs"}),
    ({"method": "bayes", "reference": "right"}, {"rows": (100, 100)}),
    ({"method": "ssd", "disparities_y": (-1, 1)}, {"rows": (50, 52)}),
], ids=str)
def test_volumes_are_those_of_the_program(scene, pair, tmp_path, options, wanted):
    run_program("match", scene / "left.png", scene / "right.png", "--disparities", "0:15", "-o",
                tmp_path / ("map.flo" if "disparities_y" in options else "map.npy"), "--volume",
                tmp_path / "volume.npy", *words(options), *words(wanted, "volume-"),
                "--no-tuning")
    volume = vantage.Matcher(**RANGE, **options).volume(*pair, **wanted)
    assert same(volume.values, np.load(tmp_path / "volume.npy"))
    assert volume.disparities[0] == 0 and volume.disparities[-1] == 15
    assert len(volume.disparities) == volume.values.shape[-1]
    assert volume.level == wanted.get("level", 0)
    assert volume.first_row == wanted.get("rows", (0,))[0]
    assert (volume.disparities_y is not None) == ("disparities_y" in options)
    if volume.content == "probabilities":
        sums = np.nansum(volume.values, axis=-1)
        assert sums.max() < 1.0001 and np.median(sums) == pytest.approx(1, abs=1e-3)


def test_volumes_of_bad_input(pair):
    matcher = vantage.Matcher(**RANGE)
    with pytest.raises(vantage.Error, match="takes 1 MiB, expected at most 0: ask for some rows"):
        matcher.volume(*pair, max_bytes=1000)
    for arguments, message in [({"rows": (5, 200)}, "volume-rows is 5:200, expected rows within"),
                               ({"rows": (5, 2)}, "volume-rows is 5:2"),
                               ({"level": 9}, "volume-level is 9"), ({"kind": "?"}, "volume-kind")]:
        with pytest.raises(ValueError, match=message):
            matcher.volume(*pair, **arguments)
    with pytest.raises(ValueError, match="there is no volume with a reduced search-size"):
        vantage.Matcher("realtime", search_size="half", **RANGE).volume(*pair)


def test_posterior_moments_are_those_of_the_program(scene, pair, tmp_path):
    run_program("match", scene / "left.png", scene / "right.png", "--disparities", "0:15", "-o",
                tmp_path / "map.npy", "--posterior-mean", tmp_path / "mean.npy",
                "--posterior-variance", tmp_path / "variance.npy", "--no-tuning")
    matcher = vantage.Matcher(**RANGE)
    for result in [matcher(*pair), matcher(*pair, posterior=True)]:
        assert same(result.posterior_mean, np.load(tmp_path / "mean.npy"))
        assert same(result.posterior_variance, np.load(tmp_path / "variance.npy"))
    volume = matcher.volume(*pair)
    share = np.nan_to_num(volume.values.astype(float))
    mean = (share * volume.disparities).sum(-1) / share.sum(-1)
    assert np.allclose(mean, result.posterior_mean, atol=1e-4, equal_nan=True)
    with pytest.raises(ValueError, match="there are no probabilities"):
        vantage.Matcher(method="ssd", **RANGE)(*pair).posterior_mean


@pytest.mark.parametrize("reference", ["left", "right"])
def test_cyclopean_map_is_that_of_the_program(scene, pair, tmp_path, reference):
    run_program("match", scene / "left.png", scene / "right.png", "--disparities", "0:15", "-o",
                tmp_path / "map.npy", "--selection", "symmetric", "--cyclopean",
                tmp_path / "middle.npy", "--cyclopean-occlusion", tmp_path / "seen.png",
                "--reference", reference, "--no-tuning")
    result = vantage.Matcher(**RANGE, selection="symmetric", reference=reference)(*pair)
    assert same(result.cyclopean, np.load(tmp_path / "middle.npy"))
    assert same(result.cyclopean_occlusion, vantage.read_image(tmp_path / "seen.png"))
    with pytest.raises(ValueError, match="expected it with selection=\"symmetric\" only"):
        vantage.Matcher(**RANGE)(*pair).cyclopean
