"""Depths, points and surfaces are those of `vantage match` and `vantage reproject`, byte for byte."""

import numpy as np
import pytest
from conftest import run_program, same, words

import vantage

RANGE = {"disparities": (0, 15)}


@pytest.fixture(scope="module")
def result(pair):
    return vantage.Matcher(**RANGE)(*pair)


@pytest.fixture(scope="module")
def calibration(scene):
    return vantage.Calibration.load(scene / "calib.txt")


@pytest.mark.parametrize("options", [
    {},
    {"cloud_step": 3, "max_depth": 1.5, "cloud_outlines": True},
    {"cloud_min_confidence": 0.6, "cloud_confidence": True, "cloud_filled": True,
     "cloud_gradient_limit": 0.25},
], ids=str)
def test_files_are_those_of_the_program(scene, result, calibration, tmp_path, options):
    files = {name: tmp_path / name for name in ["depth.png", "depth.npy", "cloud.ply", "mesh.ply"]}
    arguments = ["match", scene / "left.png", scene / "right.png", "-o", tmp_path / "map.npy",
                 "--disparities", "0:15", "--calibration", scene / "calib.txt", "--no-tuning",
                 *words(options)]
    run_program(*arguments, "--depth", files["depth.npy"], "--cloud", files["cloud.ply"], "--mesh",
                files["mesh.ply"])
    cloud = result.cloud(calibration, **options)
    mesh = result.mesh(scene / "calib.txt", **options)
    depth = result.depth(calibration, max_depth=options.get("max_depth"))
    assert same(depth, np.load(files["depth.npy"]))
    vantage.write_cloud(tmp_path / "ours.ply", cloud)
    assert (tmp_path / "ours.ply").read_bytes() == files["cloud.ply"].read_bytes()
    vantage.write_mesh(tmp_path / "ours.ply", mesh)
    assert (tmp_path / "ours.ply").read_bytes() == files["mesh.ply"].read_bytes()
    # What is made of the arrays alone.
    assert cloud.points.shape == cloud.colours.shape == (len(cloud), 3)
    again = vantage.PointCloud(cloud.points.astype(np.float64), cloud.colours, cloud.confidence)
    vantage.write_cloud(tmp_path / "again.ply", again)
    assert (tmp_path / "again.ply").read_bytes() == files["cloud.ply"].read_bytes()
    again = vantage.Mesh(mesh.points, mesh.colours, mesh.triangles[::-1][::-1], mesh.confidence)
    vantage.write_mesh(tmp_path / "again.ply", again)
    assert (tmp_path / "again.ply").read_bytes() == files["mesh.ply"].read_bytes()


@pytest.mark.parametrize("reference", ["left", "right"])
def test_rig_without_calibration(scene, pair, tmp_path, reference):
    rig = {"focal_length": 150, "baseline": 25, "doffs": 2.7, "principal_point": [70, 61.5]}
    run_program("match", scene / "left.png", scene / "right.png", "-o", tmp_path / "map.npy",
                "--disparities", "0:15", "--reference", reference, "--no-tuning",
                *words(rig), "--depth", tmp_path / "depth.png", "--cloud",
                tmp_path / "cloud.ply", "--depth-resolution", tmp_path / "resolution.npy",
                "--unmatched", tmp_path / "mask.png")
    result = vantage.Matcher(**RANGE, reference=reference)(*pair)
    image = pair[0 if reference == "left" else 1]
    depth = vantage.depth(result.disparity, reference=reference, **rig)
    assert same(depth, result.depth(**rig)) and np.nanmax(depth) > 65.535
    vantage.write_depth(tmp_path / "ours.png", depth)  # beyond what it holds: unknown
    assert (tmp_path / "ours.png").read_bytes() == (tmp_path / "depth.png").read_bytes()
    for cloud in [result.cloud(**rig),
                  vantage.cloud(result.disparity.astype(np.float64), image[..., ::-1], bgr=True,
                                unmatched=result.unmatched, reference=reference, **rig)]:
        vantage.write_cloud(tmp_path / "ours.ply", cloud)
        assert (tmp_path / "ours.ply").read_bytes() == (tmp_path / "cloud.ply").read_bytes()
    resolution = result.depth_resolution(**rig)
    assert same(resolution, np.load(tmp_path / "resolution.npy"))
    assert same(resolution, vantage.depth_resolution(result.disparity, reference=reference, **rig))
    if reference == "left":
        given = vantage.Calibration.from_focal_length(150, 25, doffs_px=2.7,
                                                      principal_point_px=(70, 61.5))
        assert given.rectified and given.metres_per_unit == 1
        assert np.allclose(result.cloud(given).points, result.cloud(**rig).points, rtol=1e-6)
        middle = vantage.Calibration.from_focal_length(150, 25, image_size=(160, 120))
        assert middle.K1[0, 2] == 79.5
        assert same(result.depth(middle), result.depth(focal_length=150, baseline=25))


def test_points_are_where_the_depth_says(result, calibration, truth):
    points = vantage.reproject(truth, calibration)
    metres = vantage.depth(truth, calibration)
    assert np.allclose(points[..., 2] * calibration.metres_per_unit, metres, rtol=1e-6)
    cloud = vantage.cloud(truth, np.zeros((120, 160), np.uint8), calibration, cloud_outlines=True)
    known = np.isfinite(metres)
    assert np.allclose(cloud.points, points[known] * calibration.metres_per_unit, rtol=1e-6)
    assert cloud.colours.dtype == np.uint8 and not cloud.colours.any()
    mesh = result.mesh(calibration)
    assert mesh.triangles.dtype == np.int32 and mesh.triangles.max() == len(mesh.points) - 1
    # Counter-clockwise as the camera at the origin sees them.
    a, b, c = (mesh.points[mesh.triangles[:, i]] for i in range(3))
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0).mean() > 0.99


def test_what_has_no_scale(result, calibration):
    unknown = vantage.Calibration(K1=calibration.K1, K2=calibration.K2, T=calibration.T,
                                  rectified=True)
    with pytest.raises(vantage.Error, match="does not say how long its unit is"):
        result.depth(unknown)
    assert same(result.depth(unknown, calibration_unit="mm"), result.depth(calibration))
    stated = vantage.Calibration(K1=calibration.K1, K2=calibration.K2, T=calibration.T,
                                 rectified=True, metres_per_unit=0.001)
    assert same(result.depth(stated), result.depth(calibration))
    with pytest.raises(ValueError, match="needs --calibration, or --focal-length and --baseline"):
        result.cloud()
    with pytest.raises(ValueError, match="metres_per_unit is 0"):
        vantage.Calibration(K1=calibration.K1, K2=calibration.K2, T=calibration.T,
                            metres_per_unit=0)
    with pytest.raises(ValueError, match="image_size and principal_point_px are not given"):
        vantage.Calibration.from_focal_length(700, 0.1)


def test_bad_matrices(calibration, truth):
    for row, column, value, message in [
            (0, 1, np.nan, "Q has values that are not finite"), (3, 2, np.inf, "not finite"),
            (2, 0, 3, "Q is not that of cameras side by side"), (3, 2, 0, "Q is not that of"),
            (2, 3, -5, "Q is not that of")]:
        matrix = calibration.Q
        matrix[row, column] = value
        with pytest.raises(ValueError, match=message):
            vantage.reproject(truth, matrix)
    for matrix in [np.zeros((4, 4)), np.eye(4), np.full((4, 4), np.nan), np.eye(3), [[1, 2], [3]]]:
        with pytest.raises(ValueError, match="^Q "):
            vantage.reproject(truth, matrix)


@pytest.mark.parametrize("given, message", [
    ({"K1": np.full((3, 3), np.nan)}, "left camera's matrix has values that are not finite"),
    ({"K2": np.zeros((3, 3))}, "right camera's fx is 0"),
    ({"K1": np.eye(4)}, "K1 has the shape 4x4, expected 3x3"),
    ({"K1": "K"}, "K1 is of type str, expected 3x3 numbers"),
    ({"D1": [np.nan] * 4}, "left camera has the distortion coefficient nan"),
    ({"D2": np.zeros((2, 4))}, "D2 has the shape 2x4, expected a row of numbers"),
    ({"R": np.full((3, 3), np.nan)}, "R or T has values that are not finite"),
    ({"T": [0, 0, 0]}, r"baseline \(length of T\) is 0"),
    ({"T": [1, 0]}, "T has 2 numbers, expected 3"),
    ({"T": [-1, np.inf, 0]}, "R or T has values that are not finite"),
    ({"image_size": (1.5, 3)}, r"image_size is \(1.5, 3\), expected"),
])
def test_bad_cameras(calibration, given, message):
    cameras = {"K1": calibration.K1, "T": [-0.1, 0, 0], **given}
    with pytest.raises(ValueError, match=message) as problem:
        vantage.Calibration(**cameras)
    assert "\n" not in str(problem.value)


def test_cameras_as_opencv_has_them(calibration):
    """D of calibrateCamera() is 1x5, T of stereoCalibrate() 3x1."""
    distortion = np.array([[-0.1, 0.02, 0.001, 0.002, 0.003]])
    cameras = [vantage.Calibration(calibration.K1, D, T=T)
               for D, T in [(distortion, np.array([[-0.1], [0], [0]])),
                            (distortion.T, np.array([[-0.1, 0, 0]])),
                            (distortion[0].tolist(), (-0.1, 0, 0))]]
    for one in cameras:
        assert one.D1 == distortion[0].tolist() and one.T.tolist() == [-0.1, 0, 0]


@pytest.mark.parametrize("call, message", [
    (lambda map_px, image, camera: vantage.depth(map_px.astype(">f4"), camera), "is of >f4"),
    (lambda map_px, image, camera: vantage.depth(map_px[None], camera), "shape 1x120x160"),
    (lambda map_px, image, camera: vantage.depth(map_px[:0], camera), "shape 0x160"),
    (lambda map_px, image, camera: vantage.depth(map_px, camera, max_depth=0), "max-depth is 0"),
    (lambda map_px, image, camera: vantage.depth(map_px, camera, cloud_step=2),
     "unknown option 'cloud_step'"),
    (lambda map_px, image, camera: vantage.cloud(map_px, image[1:], camera),
     "image is 160x119 but the disparity map is 160x120"),
    (lambda map_px, image, camera: vantage.cloud(map_px, image, camera,
                                                 unmatched=np.zeros((120, 160))),
     "unmatched: the array is of float64, expected bool or uint8"),
    (lambda map_px, image, camera: vantage.cloud(map_px, image, camera, cloud_confidence=True),
     "expected confidence"),
    (lambda map_px, image, camera: vantage.cloud(map_px * np.nan, image, camera), "no p"),
    (lambda map_px, image, camera: vantage.PointCloud(np.zeros((2, 2)), np.zeros((2, 3), np.uint8)),
     "points: the array has the shape 2x2, expected Nx3"),
    (lambda map_px, image, camera: vantage.PointCloud(np.zeros((2, 3)), np.zeros((1, 3), np.uint8)),
     "colours: the array has 1 rows, expected 2"),
    (lambda map_px, image, camera: vantage.PointCloud([[1.0, 2, 3]], np.zeros((1, 3), np.uint8)),
     "points is of type list, expected a NumPy array"),
    (lambda map_px, image, camera: vantage.PointCloud(np.full((1, 3), np.nan),
                                                      np.zeros((1, 3), np.uint8)),
     "points: row 0 is not finite"),
    (lambda map_px, image, camera: vantage.Mesh(np.zeros((2, 3)), np.zeros((2, 3), np.uint8),
                                                np.array([[0, 1, 2]], np.int32)),
     "triangles: row 0 has the point 2, expected 0 to 1"),
    (lambda map_px, image, camera: vantage.write_cloud(
        "cloud.pcd", vantage.cloud(map_px, image, camera)), "expected a name that ends in .ply"),
    (lambda map_px, image, camera: vantage.write_depth("depth.txt", map_px), "depth.txt"),
])
def test_bad_input(pair, truth, calibration, call, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises((vantage.Error, TypeError), match=message) as problem:
        call(truth, pair[0], calibration)
    assert "\n" not in str(problem.value) and not list(tmp_path.iterdir())


def test_images_that_changed_have_no_colours(pair, calibration):
    left = pair[0].copy()
    result = vantage.Matcher(**RANGE).compute(left, pair[1], right_disparity=True, confidence=True)
    left[0, 0, 0] ^= 1
    with pytest.raises(vantage.Error, match="images have changed since compute"):
        result.cloud(calibration)
