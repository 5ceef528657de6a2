"""What arrays are taken, of any layout, and what is refused."""

import ctypes
import mmap
import os
import tracemalloc
import warnings

import numpy as np
import pytest
from conftest import same

import vantage

MATCHER = vantage.Matcher("realtime", (0, 15), search_size="full")


def disparity(left, right, **options):
    return MATCHER.compute(left, right, **options).disparity


def layouts(image):
    """The same pixels in other places."""
    yield "contiguous", image
    padded = np.zeros((image.shape[0] + 2, image.shape[1] + 5, *image.shape[2:]), image.dtype)
    padded[1:-1, 3:-2] = image
    yield "part of rows", padded[1:-1, 3:-2]
    yield "Fortran order", np.asfortranarray(image)
    yield "upside down", np.ascontiguousarray(image[::-1])[::-1]
    yield "mirrored", np.ascontiguousarray(image[:, ::-1])[:, ::-1]
    yield "every second column", np.repeat(image, 2, axis=1)[:, ::2]
    frozen = image.copy()
    frozen.flags.writeable = False
    yield "read-only", frozen
    if image.ndim == 3:
        yield "reversed channels", np.ascontiguousarray(image[..., ::-1])[..., ::-1]
        yield "planes", np.ascontiguousarray(image.transpose(2, 0, 1)).transpose(1, 2, 0)


@pytest.mark.parametrize("kind", ["colour", "grey", "uint16", "float32", "one channel"])
def test_layouts(pair, kind):
    def convert(image):
        if kind == "colour":
            return image
        if kind == "uint16":
            return image.astype(np.uint16) * 257
        if kind == "float32":
            return image.astype(np.float32) / 255
        grey = np.ascontiguousarray(image[..., 1])
        return grey[..., None] if kind == "one channel" else grey

    left, right = map(convert, pair)
    expected = disparity(left.copy(), right.copy())
    assert np.isfinite(expected).mean() > 0.9
    for name, image in layouts(left):
        assert same(disparity(image, right), expected), name
    for name, image in layouts(right):
        assert same(disparity(left, image), expected), name


def test_repeated_values(pair):
    """Distances of 0 in memory, as np.broadcast_to() makes them."""
    for image in [pair[0][..., 1:2], pair[0][:1], pair[0][:, 5:6], pair[0][:1, :1, :1]]:
        repeated = np.broadcast_to(image, pair[0].shape)
        assert same(disparity(repeated, pair[1]), disparity(repeated.copy(), pair[1]))


@pytest.mark.parametrize("image, message", [
    (np.broadcast_to(np.uint8(0), (65000, 65000, 2)), "2 channels"),
    (np.broadcast_to(np.uint8(0), (70000, 9000)), "9000x70000 pixels"),
    (np.broadcast_to(np.int64(0), (9000, 9000)), "of int64"),
])
def test_repeated_values_are_refused_before_they_are_copied(image, message):
    tracemalloc.start()
    with pytest.raises(ValueError, match=message):
        MATCHER.compute(image, image)
    peak_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak_bytes < 1 << 20


def test_bgr(pair):
    left, right = (image[..., ::-1] for image in pair)
    assert same(disparity(left, right, bgr=True), disparity(*pair))
    # Colours matter: their luma differs.
    assert not same(disparity(left, right), disparity(*pair))


def at_end_of_memory(image):
    """The pixels in the last bytes before a page that nobody may read."""
    size = -(-image.nbytes // mmap.PAGESIZE) * mmap.PAGESIZE
    memory = np.frombuffer(mmap.mmap(-1, size + mmap.PAGESIZE), np.uint8)
    library = ctypes.CDLL(None)
    assert library.mprotect(ctypes.c_void_p(memory.ctypes.data + size), mmap.PAGESIZE, 0) == 0
    array = memory[size - image.nbytes:size].view(image.dtype).reshape(image.shape)
    array[...] = image
    return array


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
@pytest.mark.parametrize("channels", [1, 3, 4])
def test_nothing_beyond_an_array_is_read(dtype, channels):
    largest = 1 if dtype is np.float32 else np.iinfo(dtype).max
    values = np.random.default_rng(1).random((37, 65, channels)) * largest
    left, right = (np.ascontiguousarray(values[:, x:x + 61].astype(dtype)) for x in [0, 4])
    for options in [{"preset": "quality"}, {"preset": "realtime", "disparities": "auto"},
                    {"preset": None, "cost": "gradient"}, {"preset": None, "cost": "census"}]:
        matcher = vantage.Matcher(**{"disparities": (0, 15), **options})
        guarded = matcher.compute(at_end_of_memory(left), at_end_of_memory(right))
        plain = matcher.compute(left, right)
        assert same(guarded.disparity, plain.disparity)
        assert same(guarded.confidence, plain.confidence)


def test_results_outlive_what_they_come_from(pair):
    result = MATCHER.compute(*(image.copy() for image in pair))
    array = result.disparity
    expected = array.copy()
    del result
    MATCHER.compute(*pair)
    assert same(array, expected)


@pytest.mark.parametrize("change, error, message", [
    (lambda left: left.astype(np.float64), ValueError,
     r"left: the array is of float64, expected uint8, uint16 or float32"),
    (lambda left: left.astype(bool), ValueError, "left: the array is of bool"),
    (lambda left: left.astype(">u2"), ValueError, "left: the array is of >u2"),
    (lambda left: left[0, 0], ValueError, r"left: the array has 1 dimensions \(3\), expected HxW"),
    (lambda left: left[None], ValueError, "left: the array has 4 dimensions"),
    (lambda left: left[..., :2], ValueError, "left: the image has 2 channels, expected 1"),
    (lambda left: left[:0], ValueError, "left: the image has 160x0 pixels"),
    (lambda left: left[:-1], vantage.Error, "160x119"),
    (lambda left: np.ma.masked_greater(left, 200), ValueError, "left: the array is masked"),
    (lambda left: "left.png", TypeError, "left is of type str, expected a NumPy array"),
    (lambda left: None, TypeError, "left is of type NoneType"),
])
def test_bad_arrays(pair, change, error, message):
    with pytest.raises(error, match=message) as problem:
        MATCHER.compute(change(pair[0]), pair[1])
    assert "\n" not in str(problem.value)


def test_arrays_that_raise_say_what_they_say(pair):
    class Tensor:
        def __array__(self, *_, **__):
            raise TypeError("can't convert a tensor of a GPU")

    with pytest.raises(TypeError, match="tensor of a GPU"):
        MATCHER.compute(Tensor(), pair[1])


@pytest.mark.parametrize("value", [-np.inf, np.inf])
def test_floats_that_are_not_finite(pair, value):
    left = pair[0].astype(np.float32) / 255
    left[7, 5, 1] = value
    with pytest.raises(ValueError, match=rf"left: the image is {value} at pixel \(5, 7\)"):
        MATCHER.compute(left, pair[1])


def test_nan_is_no_data(pair, tmp_path):
    left, right = [image.astype(np.float32) / 255 for image in pair]
    left[7:9, 5] = np.nan
    unknown = np.isnan(MATCHER.compute(left, right).disparity)
    assert unknown[7:9, 5].all() and unknown.mean() < 0.01
    vantage.write_image(tmp_path / "left.pfm", left)
    assert same(vantage.read_image(tmp_path / "left.pfm"), left)
    green = vantage.read_image(tmp_path / "left.pfm", band=2, orientation="stored")
    assert same(green, left[..., 1])
    with pytest.raises(vantage.Error, match="has 3 bands"):
        vantage.read_image(tmp_path / "left.pfm", band=4)


@pytest.mark.parametrize("dtype, white, others", [
    (np.float32, 255, {}), (np.uint16, 1023, {}), (np.uint16, 4095, {"white_level": 4095}),
])
def test_white_level(pair, dtype, white, others):
    expected = MATCHER.compute(*pair).disparity
    images = [np.round(image * (white / 255)).astype(dtype) for image in pair]
    images[0][0, :2] = [0], [white]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        MATCHER.compute(*[image / np.float32(230) for image in pair])  # filters ring
    matcher = vantage.Matcher("realtime", (0, 15), search_size="full", **others)
    if others:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = matcher.compute(*images).disparity
    else:
        with pytest.warns(UserWarning, match=f"white level: {white} .*brightest pixels") as caught:
            found = matcher.compute(*images).disparity
            matcher.compute(*images)
            vantage.rectify(*images)
            vantage.synthesize(*images, disparities=(0, 15))
        assert len(caught) == 3
        assert {one.filename for one in caught} <= {__file__, vantage.__file__}
    assert np.mean(np.abs(found - expected) > 1) < 0.02


def test_files(tmp_path, pair):
    vantage.write_image(tmp_path / "image.png", pair[0])
    assert same(vantage.read_image(tmp_path / "image.png"), pair[0])
    assert same(vantage.read_image(tmp_path / "image.png", bgr=True), pair[0][..., ::-1])
    disparity_px = np.array([[1.5, np.nan], [0, 3]], np.float32)
    for name in ["map.pfm", "map.npy", "map.tiff"]:
        vantage.write_disparity(tmp_path / name, disparity_px.astype(np.float64))
        assert same(vantage.read_disparity(tmp_path / name), disparity_px)
    with pytest.raises(vantage.Error, match="missing.png"):
        vantage.read_image(tmp_path / "missing.png")
    for limits in [3, (1, 2, 3), "ab"]:
        with pytest.raises(ValueError, match="limits is .*, expected two numbers"):
            vantage.colours(disparity_px, limits)
    with pytest.raises(ValueError, match="map.txt"):
        vantage.write_disparity(tmp_path / "map.txt", disparity_px)
    with pytest.raises(ValueError, match=r"disparity: the array has the shape 3, expected HxW"):
        vantage.write_disparity(tmp_path / "map.pfm", np.zeros(3, np.float32))


def test_maps_of_other_tools(tmp_path):
    path = tmp_path / "map.npy"
    np.save(path, np.array([[-16, 40], [0, 81]], np.int16))
    with pytest.raises(vantage.Error, match="16 for maps of OpenCV's matchers"):
        vantage.read_disparity(path)
    with pytest.warns(UserWarning, match="-16 .minDisparity - 1"):
        found = vantage.read_disparity(path, 16)
    assert same(found, np.array([[np.nan, 2.5], [0, 5.0625]], np.float32))
    depth_m = np.array([[1, 2], [4, 0]])
    np.save(path, np.asfortranarray(depth_m))
    with pytest.warns(UserWarning, match="integers, taken as millimetres"):
        assert vantage.read_depth(path)[0, 0] == np.float32(0.001)
    with pytest.warns(UserWarning, match="1 per metre"):
        found = vantage.read_depth(path, 1)
    assert same(found, np.array([[1, 2], [4, np.nan]], np.float32))
    rig = {"focal_length": 300, "baseline": 0.12, "doffs": 2}
    disparity_px = vantage.disparity(found, **rig)
    assert same(disparity_px, np.array([[34, 16], [7, np.nan]], np.float32))
    assert same(vantage.depth(disparity_px, **rig), found)
    with pytest.raises(ValueError, match="calibration"):
        vantage.disparity(found)
    with pytest.raises(ValueError, match="max.depth"):
        vantage.disparity(found, **rig, max_depth=3)


def test_names_of_any_bytes(tmp_path, pair):
    folder = os.fsencode(tmp_path) + b"/\xff\xe9"
    os.mkdir(folder)
    for name in (folder + b"/a.png", os.fsdecode(folder + b"/b.png")):
        vantage.write_image(name, pair[0])
        assert (vantage.read_image(name) == pair[0]).all()
    with pytest.raises(vantage.Error, match=r"\\xFF\\xE9/none.png"):
        vantage.read_image(folder + b"/none.png")
    for side in ("left", "right"):
        os.mkdir(folder + b"/" + side.encode())
        vantage.write_image(folder + b"/" + side.encode() + b"/0.png", pair[0])
    for convert in (os.fsdecode, lambda name: name):
        names = [convert(folder + b"/" + side) for side in (b"left", b"right")]
        frames = list(vantage.Sequence(*names, disparities=(0, 7), method="ssd"))
        assert len(frames) == 1


@pytest.mark.parametrize("name", ["a\0b.png", b"a\0b.png"])
def test_names_with_a_null_character(name, pair):
    with pytest.raises(ValueError, match="null character"):
        vantage.read_image(name)
    with pytest.raises(ValueError, match="null character"):
        vantage.write_image(name, pair[0])
    with pytest.raises(ValueError, match="null character"):
        vantage.Sequence(name, name)
