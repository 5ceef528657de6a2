"""The examples for other programs, with stand-ins that have the fields of their documentation."""

import importlib.util
import itertools
import shutil
import struct
import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from unittest.mock import MagicMock

import cv2
import numpy as np
import pytest

import vantage

EXAMPLES = Path(__file__).parent.parent.parent / "examples"


def example(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


# Messages of ROS 2.

def ros_image(encoding, height, width, step, data, is_bigendian=0):
    return SimpleNamespace(header="left", encoding=encoding, height=height, width=width, step=step,
                           is_bigendian=is_bigendian, data=data)


def ros_camera(fx, cx, cy, tx=0.0, binning=0, offset=(0, 0)):
    roi = SimpleNamespace(x_offset=offset[0], y_offset=offset[1])
    return SimpleNamespace(p=[fx, 0, cx, tx, 0, fx, cy, 0, 0, 0, 1, 0], roi=roi,
                           binning_x=binning, binning_y=binning)


@pytest.mark.parametrize("encoding, layout, is_bigendian, pixel, expected", [
    ("mono8", "<B", 0, [7], 7), ("mono16", "<H", 0, [0x1234], 0x1234),
    ("mono16", ">H", 1, [0x1234], 0x1234), ("bgr8", "<3B", 0, [1, 2, 3], [3, 2, 1]),
    ("bgra8", "<4B", 0, [1, 2, 3, 9], [3, 2, 1]), ("rgb16", ">3H", 1, [256, 2, 3], [256, 2, 3])])
def test_ros_images(encoding, layout, is_bigendian, pixel, expected):
    pixels = bytes(4 * struct.calcsize(layout)) + struct.pack(layout, *pixel)
    row = pixels + b"\xff" * 3
    message = ros_image(encoding, 2, 5, len(row), row * 2, is_bigendian)
    image = example("ros2_disparity_node").image_of(message)
    assert image.shape[:2] == (2, 5) and image.dtype.itemsize == (2 if "16" in encoding else 1)
    assert np.array_equal(image[1, 4], expected) and not image[:, :4].any()


def test_ros_geometry_is_that_of_the_projection_matrices():
    """[u v w]' = P [X Y Z 1]' in cameras whose images are cut at (16, 8) and halved."""
    node = example("ros2_disparity_node")
    window = {"binning": 2, "offset": (16, 8)}
    left, right = ros_camera(200, 99, 61, **window), ros_camera(200, 107, 61, -50, **window)
    height, width = 40, 70
    v, u = np.indices((height, width), float)
    z = 1.5 + 0.01 * u + 0.02 * v
    x, y = (2 * u + 16 - 99) * z / 200, (2 * v + 8 - 61) * z / 200
    u_right = ((200 * x + 107 * z - 50) / z - 16) / 2
    result = SimpleNamespace(disparity=(u - u_right).astype(np.float32), disparities=(-20, 30))
    result.disparity[3, 5] = np.nan
    colours = np.full((height, width, 3), [10, 20, 30], np.uint8)
    rig = node.rig_of(left, right, colours)

    message = SimpleNamespace(image=SimpleNamespace(), valid_window=SimpleNamespace())
    node.fill_disparity(message, "header", result, rig)
    image = message.image
    assert message.header == image.header == "header"
    assert (image.encoding, image.step, image.is_bigendian) == ("32FC1", 4 * width, 0)
    values = np.reshape(struct.unpack(f"<{width * height}f", image.data), (height, width))
    known = values >= message.min_disparity  # "any disparity less than min_disparity is invalid"
    assert not known[3, 5] and known.sum() == known.size - 1
    assert np.allclose((message.f * message.t / values)[known], z[known], rtol=1e-5)
    nearest = 100 * 0.25 / (30 + 4)  # doffs: half of 107 - 99
    assert np.isclose(message.f * message.t / message.max_disparity, nearest)
    assert (message.valid_window.width, message.valid_window.height) == (width, height)

    cloud = SimpleNamespace()
    node.fill_points(cloud, SimpleNamespace, "header", result, rig, colours)
    assert [(field.name, field.datatype) for field in cloud.fields] == [
        (name, 7) for name in ["x", "y", "z", "rgb"]]
    at = 17 * cloud.row_step + 31 * cloud.point_step
    found = [struct.unpack_from(layout, cloud.data, at + field.offset)[0]
             for layout, field in zip(["<f", "<f", "<f", "<I"], cloud.fields)]
    assert np.allclose(found[:3], [part[17, 31] for part in (x, y, z)], rtol=1e-5)
    assert found[3] == 0x0A141E and len(cloud.data) == cloud.row_step * cloud.height
    for wrong in (ros_camera(0, 0, 0), ros_camera(200, 99, 61, 50)):
        with pytest.raises(ValueError):
            node.rig_of(left, wrong, colours)


def test_ros_node_publishes_what_it_matched(pair, monkeypatch):
    ros = MagicMock()
    for module in ["rclpy", "rclpy.qos", "message_filters", "sensor_msgs.msg", "stereo_msgs.msg"]:
        monkeypatch.setitem(sys.modules, module, ros)
    node = ros.create_node.return_value
    node.declare_parameter.side_effect = lambda name, value: SimpleNamespace(
        value="0:15" if name == "disparities" else value)
    example("ros2_disparity_node").main()
    assert [call.args[2] for call in ros.Subscriber.call_args_list] == [
        "left/image_rect", "left/camera_info", "right/image_rect", "right/camera_info"]
    messages = []
    for image, tx in zip(pair, [0, -18]):
        messages += [ros_image("rgb8", 120, 160, 480, image.tobytes()), ros_camera(180, 80, 60, tx)]
    ros.TimeSynchronizer.return_value.registerCallback.call_args.args[0](*messages)
    made = node.create_publisher
    assert [call.args[1] for call in made.call_args_list] == ["disparity", "points2"]
    disparity, points = (call.args[0] for call in made.return_value.publish.call_args_list)
    values = np.frombuffer(disparity.image.data, np.float32).reshape(120, 160)
    expected = vantage.Matcher("realtime", disparities=(0, 15), fill="none")(*pair).disparity
    assert np.array_equal(values, np.where(np.isnan(expected), -1, expected))
    assert (points.header, points.width) == ("left", 160)


# Depth cameras.

ROTATION = np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]])


def realsense_lens(model, coeffs, K, size):
    return SimpleNamespace(width=size[0], height=size[1], fx=K[0, 0], fy=K[1, 1], ppx=K[0, 2],
                           ppy=K[1, 2], model=f"distortion.{model}", coeffs=coeffs)


def test_realsense_calibration():
    make = example("depth_cameras").realsense_calibration
    K = np.array([[385.0, 0, 318], [0, 386, 239], [0, 0, 1]])
    lens = realsense_lens("brown_conrady", [0.1, 0.2, 0.3, 0.4, 0.5], K, (640, 480))
    place = SimpleNamespace(rotation=[*ROTATION.T.ravel()], translation=[-0.05, 0.001, 0.002])
    rig = make(lens, lens, place)
    assert np.allclose(rig.R, ROTATION) and np.allclose(rig.T, place.translation)
    assert np.allclose(rig.K1, K) and (rig.D1, rig.metres_per_unit) == (lens.coeffs, 1)
    with pytest.raises(ValueError, match="inverse_brown_conrady"):
        make(realsense_lens("inverse_brown_conrady", [0.1] * 5, K, (640, 480)), lens, place)


def test_realsense_depths_are_those_of_the_scene(scene, pair, truth, tmp_path):
    cameras = example("depth_cameras")
    K = vantage.Calibration.load(scene / "calib.txt").K1
    lens = realsense_lens("brown_conrady", [0.0] * 5, K, (160, 120))
    place = SimpleNamespace(rotation=[1.0, 0, 0, 0, 1, 0, 0, 0, 1], translation=[-0.1, 0, 0])
    infrared = [SimpleNamespace(get_data=lambda image=image: image[..., 1]) for image in pair]
    frames = SimpleNamespace(get_infrared_frame=lambda number: infrared[number - 1])
    waits = iter([(True, frames), (True, frames), (False, None)])
    pipeline = SimpleNamespace(try_wait_for_frames=lambda timeout_ms: next(waits))
    cameras.write_depths(cameras.realsense_pairs(pipeline),
                         cameras.realsense_calibration(lens, lens, place), tmp_path, False,
                         disparities=(0, 15))
    assert sorted(file.name for file in tmp_path.iterdir()) == ["000000.png", "000001.png"]
    depth_mm = cv2.imread(str(tmp_path / "000001.png"), cv2.IMREAD_UNCHANGED)
    assert (depth_mm > 0).mean() > 0.9
    disparity = K[0, 0] * 100 / np.where(depth_mm > 0, depth_mm, np.nan)
    assert np.nanmedian(np.abs(disparity - truth)) < 0.15


@pytest.mark.parametrize("model, used", [("Perspective", 14), ("Fisheye", 4)])
def test_oak_calibration(model, used):
    place = np.eye(4)
    place[:3, :3], place[:3, 3] = ROTATION, [-7.5, 0.1, 0.2]  # centimetres
    coefficients = [0.01 * number for number in range(14)]
    handler = SimpleNamespace(
        getDistortionModel=lambda socket: f"CameraModel.{model}",
        getCameraExtrinsics=lambda source, target: {"BC": place.tolist()}[source + target],
        getCameraIntrinsics=lambda socket, width, height: np.diag([width, height, 1]).tolist(),
        getDistortionCoefficients=lambda socket: coefficients)
    cameras = example("depth_cameras")
    rig = cameras.oak_calibration(handler, "B", "C", (640, 400))
    assert np.allclose(rig.R, ROTATION) and np.allclose(rig.T, [-0.075, 0.001, 0.002])
    assert rig.K1[0, 0] == 640 and rig.D1 == coefficients[:used] and rig.metres_per_unit == 1
    group = {side: SimpleNamespace(getCvFrame=lambda side=side: side) for side in ["left", "right"]}
    pairs = cameras.oak_pairs(SimpleNamespace(get=lambda: group))
    assert [*itertools.islice(pairs, 2)] == [("left", "right")] * 2


# pandora: its registry of methods, and its datasets.

class AbstractDisparity:
    methods = {}

    def __new__(cls, **cfg):
        return super().__new__(cls.methods[cfg["disparity_method"]])

    @classmethod
    def register_subclass(cls, name):
        return lambda subclass: cls.methods.setdefault(name, subclass)


def pandora_image(xarray, pixels):
    mask = np.zeros(pixels.shape, np.int16)
    mask[10:20, 60:80], mask[40:50, 60:80] = 1, 2  # no data; not to be matched
    grid = {"row": np.arange(120), "col": np.arange(160)}
    bands = np.stack([np.zeros((120, 160)), pixels.astype(np.float32) * 9 + 300])
    return xarray.Dataset(
        {"im": (["band_im", *grid], bands), "msk": ([*grid], mask)},
        {"band_im": ["none", "green"], **grid},
        {"no_data_img": 0, "valid_pixels": 0, "no_data_mask": 1})


def test_pandora_step(pair, truth, monkeypatch):
    xarray = pytest.importorskip("xarray", reason="no python3-xarray")
    for name in ["pandora", "pandora.disparity", "pandora.disparity.disparity"]:
        monkeypatch.setitem(sys.modules, name, ModuleType(name))
    sys.modules["pandora.disparity.disparity"].AbstractDisparity = AbstractDisparity
    example("pandora_plugin")
    with pytest.raises(vantage.UsageError, match="presset"):
        AbstractDisparity(disparity_method="vantage", presset="balanced")
    step = AbstractDisparity(disparity_method="vantage", invalid_disparity=-999, band="green")
    left, right = (pandora_image(xarray, image[..., 1]) for image in pair)
    for images, first, last in [((left, right), -15, -2), ((right, left), 2, 15)]:
        spread = left.msk.expand_dims({"indicator": ["spread"]}, 2)
        cv = xarray.Dataset({"confidence_measure": spread}, {"disp": np.arange(first, last + 1)},
                            {"measure": "zncc"})
        with pytest.warns(UserWarning, match="white level"):
            found = step.to_disp(cv, *images)
        bits, disparity = found.validity_mask.values, found.disparity_map.values
        assert (bits.dtype, disparity.dtype, found.attrs) == (np.uint16, np.float32, cv.attrs)
        assert found.confidence_measure.dims == ("row", "col", "indicator")
        assert [*found.indicator.values] == ["spread", "confidence_from_vantage"]
        valid = bits & 0b1111000011 == 0  # bits that say: the point is invalid
        assert valid.mean() > 0.8 and (disparity != -999)[valid].all()
        assert (bits[10:20, 60:80] & 1).all() and (bits[40:50, 60:80] & 1 << 6).all()
        assert (disparity[10:20, 60:80] == -999).all() and (disparity[40:50, 60:80] == -999).all()
        for column in range(160):
            partners = sum(0 <= column + d < 160 for d in range(first, last + 1))
            assert bool(bits[60, column] & 4) == (partners <= last - first)
            assert bool(bits[60, column] & 2) == (partners == 0)
        if first < 0:
            assert np.median(np.abs(disparity + truth)[valid]) < 0.25
        else:
            assert np.median(disparity[valid]) > 2


@pytest.mark.skipif(not shutil.which("oiiotool"), reason="no openimageio-tools")
def test_depths_for_compositors(tmp_path):
    image_io = pytest.importorskip("OpenImageIO", reason="no python3-openimageio")
    depth = np.float32([[1.25, np.nan, 70000.5], [3, 0.001, 2]])
    vantage.write_depth(tmp_path / "depth.exr", depth)
    subprocess.run("oiiotool depth.exr --fixnan black --chnames Z -o z.exr".split(), cwd=tmp_path,
                   check=True)
    file = image_io.ImageInput.open(str(tmp_path / "z.exr"))
    assert (file.spec().channelnames, str(file.spec().format)) == (("Z",), "float")
    assert np.array_equal(file.read_image("float")[..., 0], np.nan_to_num(depth))
