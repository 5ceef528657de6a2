"""Views, rectification, points, and OpenCV's interface."""

import pickle

import cv2
import numpy as np
import pytest
from conftest import run_program, same, unrectified_pair

import vantage

RANGE = {"disparities": (0, 15)}


def test_view_is_that_of_the_program(scene, pair, tmp_path):
    files = scene / "left.png", scene / "right.png"
    run_program("synth", *files, "--view", "0.25", "--disparities", "0:15", "--holes", "texture",
                "-o", tmp_path / "view.png")
    view = vantage.synthesize(*pair, 0.25, holes="texture", **RANGE)
    assert same(view, vantage.read_image(tmp_path / "view.png"))
    bgr = vantage.synthesize(*(image[..., ::-1] for image in pair), 0.25, holes="texture", bgr=True,
                             **RANGE)
    assert same(bgr[..., ::-1], view)


def test_several_views(scene, pair, tmp_path):
    run_program("synth", scene / "left.png", scene / "right.png", "--sweep", "0:1:3",
                "--disparities", "0:15", "-o", tmp_path / "%d.png")
    expected = [vantage.read_image(tmp_path / f"{number}.png") for number in range(3)]
    maps = vantage.Matcher(**RANGE)(*pair)
    for views in [vantage.synthesize(*pair, sweep="0:1:3", **RANGE),
                  vantage.synthesize(*pair, [0, 0.5, (1.0, 0)], disparity=maps.disparity,
                                     right_disparity=maps.right_disparity)]:
        assert len(views) == 3 and all(map(same, views, expected))


def test_view_of_a_camera(scene, pair, tmp_path):
    calibration = vantage.Calibration.load(scene / "calib.txt")
    pose = {"K": calibration.K1, "R": np.eye(3), "t": [-0.5, 0, 0.1]}
    (tmp_path / "pose.toml").write_text(
        f"[[view]]\nK = {calibration.K1.tolist()}\nR = {np.eye(3).tolist()}\nt = [-0.5, 0, 0.1]\n")
    run_program("synth", scene / "left.png", scene / "right.png", "--pose", tmp_path / "pose.toml",
                "--calibration", scene / "calib.txt", "--disparities", "0:15", "-o",
                tmp_path / "view.png")
    view = vantage.synthesize(*pair, pose, calibration=calibration, **RANGE)
    assert same(view, vantage.read_image(tmp_path / "view.png"))
    with pytest.raises(ValueError, match="calibrat"):
        vantage.synthesize(*pair, pose, **RANGE)


def test_fisheye_lenses(tmp_path):
    camera = np.array([[180.0, 0, 80], [0, 180, 60], [0, 0, 1]])
    coefficients = np.array([[0.05], [-0.02], [0.01], [-0.003]])
    path = str(tmp_path / "rig.json")
    file = cv2.FileStorage(path, cv2.FILE_STORAGE_WRITE)
    for name, matrix in [("K1", camera), ("D1", coefficients), ("K2", camera),
                         ("D2", coefficients), ("R", np.eye(3)),
                         ("T", np.array([[-0.1], [0], [0]]))]:
        file.write(name, matrix)
    file.release()
    with pytest.raises(vantage.Error, match="D1 is 4x1 and no key says of which lens"):
        vantage.Calibration.load(path)
    loaded = vantage.Calibration.load(path, lens="fisheye")
    made = vantage.Calibration(camera, coefficients, T=[-0.1, 0, 0], D2=coefficients,
                               lens="fisheye")
    for rig in [loaded, made, pickle.loads(pickle.dumps(made))]:
        assert rig.lens == "fisheye" and rig.D1 == coefficients.ravel().tolist()
    assert vantage.Calibration.load(path, lens="standard").lens == "standard"
    with pytest.raises(ValueError, match="lens is 'wide', expected"):
        vantage.Calibration.load(path, lens="wide")


def test_cameras_of_kitti(tmp_path):
    rows = "70 0 35 {} 0 70 26 0 0 0 1 0"
    (tmp_path / "calib.txt").write_text(
        "".join(f"P{i}: {rows.format(x)}\n" for i, x in enumerate([0, -35, 7, -35])))
    with pytest.warns(UserWarning, match=r"0 and 1 \(grey\) are used; kitti_cameras=\(2, 3\)"):
        assert vantage.Calibration.load(tmp_path / "calib.txt").baseline == pytest.approx(0.5)
    colour = vantage.Calibration.load(tmp_path / "calib.txt", kitti_cameras=(2, 3))
    assert colour.baseline == pytest.approx(0.6)
    with pytest.raises(ValueError, match=r"kitti_cameras is \(1, 2\), expected"):
        vantage.Calibration.load(tmp_path / "calib.txt", kitti_cameras=(1, 2))
    of_folders = vantage.Calibration.load(tmp_path / "calib.txt", images=["image_2/0.png"])
    assert of_folders.baseline == colour.baseline


def test_views_of_bad_input(pair):
    with pytest.raises(ValueError, match=r"view is at 99, 0 baselines, expected both within -16"):
        vantage.synthesize(*pair, 99)
    with pytest.raises(ValueError, match="one of disparity and right_disparity is missing"):
        vantage.synthesize(*pair, disparity=np.zeros((120, 160), np.float32))
    with pytest.raises(ValueError, match="disparity: the map has 2x2 pixels, expected 160x120"):
        vantage.synthesize(*pair, disparity=np.zeros((2, 2), np.float32),
                           right_disparity=np.zeros((2, 2), np.float32))


def tilted(scene):
    """A calibration whose right camera is turned, so that pairs need rectification."""
    load = vantage.Calibration.load(scene / "calib.txt")
    angle = 0.02
    turn = np.array([[1, 0, 0], [0, np.cos(angle), -np.sin(angle)],
                     [0, np.sin(angle), np.cos(angle)]])
    return vantage.Calibration(K1=load.K1, K2=load.K2, R=turn, T=load.T, D1=[-0.1, 0.01, 0, 0],
                               image_size=load.image_size)


def test_rectification_is_that_of_the_program(scene, pair, tmp_path):
    calibration = tilted(scene)
    storage = cv2.FileStorage(str(tmp_path / "rig.yml"), cv2.FILE_STORAGE_WRITE)
    for name, value in [("M1", calibration.K1), ("D1", np.array([calibration.D1])),
                        ("M2", calibration.K2), ("R", calibration.R), ("T", calibration.T)]:
        storage.write(name, np.asarray(value, float))
    storage.release()
    run_program("rectify", scene / "left.png", scene / "right.png", "--calibration",
                tmp_path / "rig.yml", "-o", tmp_path / "rectified", "--matrices",
                tmp_path / "out.yml")
    rectified = vantage.rectify(*pair, calibration)
    assert rectified.calibration.metres_per_unit == calibration.metres_per_unit
    left, right = rectified
    assert same(left, vantage.read_image(tmp_path / "rectified/left.png"))
    assert same(right, vantage.read_image(tmp_path / "rectified/right.png"))
    assert rectified.row_error_px is None and not calibration.rectified
    # Q is the one of cv2.stereoRectify's convention, up to scale.
    storage = cv2.FileStorage(str(tmp_path / "out.yml"), cv2.FILE_STORAGE_READ)
    q = storage.getNode("Q").mat()
    ours = rectified.calibration.Q
    assert np.allclose(ours / ours[3, 2], q / q[3, 2], rtol=1e-6, atol=1e-9)
    with pytest.warns(UserWarning, match="rows: .*; corrected"):
        view = vantage.synthesize(*pair, calibration=tmp_path / "rig.yml", **RANGE)
    run_program("synth", scene / "left.png", scene / "right.png", "--calibration",
                tmp_path / "rig.yml", "--view", "0.5", "--disparities", "0:15",
                "-o", tmp_path / "view.png")
    assert same(view, vantage.read_image(tmp_path / "view.png"))


def test_rectification_without_cameras():
    left, right = unrectified_pair()
    rectified = vantage.rectify(left, right)
    assert rectified.row_error_px < 0.5
    assert rectified.left.shape == left.shape and rectified.calibration.rectified
    with pytest.raises(vantage.Error, match="matches|points"):
        vantage.rectify(np.zeros_like(left), np.zeros_like(left))
    with pytest.raises(vantage.Error, match="expected equal sizes"):
        vantage.rectify(left, right[:-1])


def test_points(scene, truth):
    calibration = vantage.Calibration.load(scene / "calib.txt")
    disparity = truth.copy()
    disparity[3, 4] = np.nan
    disparity[5, 6] = 0
    points = vantage.reproject(disparity, calibration)
    assert points.shape == (120, 160, 3) and points.dtype == np.float32
    assert np.isnan(points[3, 4]).all() and np.isnan(points[5, 6]).all()
    f, cx, cy = calibration.K1[0, 0], calibration.K1[0, 2], calibration.K1[1, 2]
    z = f * calibration.baseline / (truth[50, 70] + calibration.doffs)
    assert np.allclose(points[50, 70], [(70 - cx) * z / f, (50 - cy) * z / f, z], rtol=1e-5)
    # Projected back, they are where they were.
    z = points[..., 2]
    back = np.stack([f * points[..., 0] / z + cx, f * points[..., 1] / z + cy], axis=-1)
    rows, columns = np.indices(truth.shape)
    known = np.isfinite(z)
    assert np.allclose(back[known], np.stack([columns, rows], -1)[known], atol=1e-3)
    assert calibration.metres_per_unit == 0.001  # Middlebury's
    assert vantage.Calibration(K1=calibration.K1, K2=calibration.K2,
                               T=calibration.T).metres_per_unit is None
    opencv = cv2.reprojectImageTo3D(truth, calibration.Q)
    assert np.allclose(vantage.reproject(truth, calibration.Q), opencv, rtol=1e-4)
    for bad, message in [(truth.astype(int), "is of int64, expected float32"), (truth[0], "HxW")]:
        with pytest.raises(ValueError, match=message):
            vantage.reproject(bad, calibration)
    with pytest.raises(vantage.Error, match="not one of rectified images"):
        vantage.reproject(truth, tilted(scene))
    with pytest.raises(vantage.Error, match="missing.yml"):
        vantage.Calibration.load("missing.yml")
