"""Depths in metres from the two cameras of a RealSense or an OAK, matched by Vantage.

    python3 depth_cameras.py realsense depths/ [--bag recording.bag] [--max-depth 6]
    python3 depth_cameras.py oak depths/

Needs pyrealsense2, or depthai 3. The functions that make calibrations and pairs take the objects of
these modules, and import neither.
"""

import argparse
import pathlib

import numpy as np

import vantage

CM_PER_M = 100


def realsense_calibration(left, right, left_to_right):
    """A vantage.Calibration in metres of rs.intrinsics of both cameras and rs.extrinsics."""
    def distortion(camera):
        model = str(camera.model).rpartition(".")[2]
        if model != "brown_conrady" and any(camera.coeffs):
            raise ValueError(f"distortion is {model}, expected brown_conrady or none")
        return list(camera.coeffs)  # k1, k2, p1, p2, k3, as OpenCV has them

    def matrix(camera):
        return np.array([[camera.fx, 0, camera.ppx], [0, camera.fy, camera.ppy], [0, 0, 1]])

    rotation = np.reshape(left_to_right.rotation, (3, 3), order="F")  # column-major
    return vantage.Calibration(matrix(left), distortion(left), matrix(right), distortion(right),
                               rotation, left_to_right.translation,
                               image_size=(left.width, left.height), metres_per_unit=1)


def oak_calibration(handler, left, right, size_px):
    """The same of a dai.CalibrationHandler; left, right: sockets; size_px: (width, height)."""
    sockets = (left, right)
    models = [str(handler.getDistortionModel(socket)).rpartition(".")[2] for socket in sockets]
    if models not in (["Perspective"] * 2, ["Fisheye"] * 2):
        raise ValueError(f"lenses are {models}, expected two of Perspective or Fisheye")
    is_fisheye = models[0] == "Fisheye"
    left_to_right = np.array(handler.getCameraExtrinsics(left, right))  # 4x4, centimetres
    lenses = [(handler.getCameraIntrinsics(socket, *size_px),
               handler.getDistortionCoefficients(socket)[:4 if is_fisheye else 14])
              for socket in sockets]
    return vantage.Calibration(*lenses[0], *lenses[1], left_to_right[:3, :3],
                               left_to_right[:3, 3] / CM_PER_M, image_size=size_px,
                               metres_per_unit=1, lens="fisheye" if is_fisheye else "standard")


def realsense_pairs(pipeline, timeout_ms=2000):
    """(left, right) of the infrared cameras, HxW of uint8, until frames fail to come."""
    while True:
        is_there, frames = pipeline.try_wait_for_frames(timeout_ms)
        if not is_there:
            return
        pair = [frames.get_infrared_frame(number) for number in (1, 2)]
        if all(pair):
            yield tuple(np.asanyarray(frame.get_data()) for frame in pair)


def oak_pairs(queue):
    """(left, right), HxW of uint8, of a queue of dai.node.Sync with inputs "left" and "right"."""
    while True:
        group = queue.get()
        yield group["left"].getCvFrame(), group["right"].getCvFrame()


def open_realsense(bag):
    import pyrealsense2 as rs
    pipeline, config = rs.pipeline(), rs.config()
    if bag:
        config.enable_device_from_file(bag, repeat_playback=False)
    for number in (1, 2):
        config.enable_stream(rs.stream.infrared, number)
    profile = pipeline.start(config)
    if bag:
        profile.get_device().as_playback().set_real_time(False)  # no frame is dropped
    left, right = (profile.get_stream(rs.stream.infrared, number).as_video_stream_profile()
                   for number in (1, 2))
    return realsense_pairs(pipeline), realsense_calibration(
        left.get_intrinsics(), right.get_intrinsics(), left.get_extrinsics_to(right))


def open_oak(size_px=(640, 400)):
    import depthai as dai
    pipeline = dai.Pipeline()
    sockets = {"left": dai.CameraBoardSocket.CAM_B, "right": dai.CameraBoardSocket.CAM_C}
    sync = pipeline.create(dai.node.Sync)
    for name, socket in sockets.items():
        camera = pipeline.create(dai.node.Camera).build(socket)
        camera.requestOutput(size_px, type=dai.ImgFrame.Type.GRAY8).link(sync.inputs[name])
    queue = sync.out.createOutputQueue()
    handler = pipeline.getDefaultDevice().readCalibration()
    pipeline.start()
    return oak_pairs(queue), oak_calibration(handler, *sockets.values(), size_px)


def write_depths(pairs, rig, folder, live, max_depth=None, **options):
    """Writes depths of the rectified left camera as PNG in millimetres; options: of Sequence."""
    folder.mkdir(parents=True, exist_ok=True)
    for frame in vantage.Sequence(pairs=pairs, calibration=rig, live=live, **options):
        depth = frame.result.depth(max_depth=max_depth)
        vantage.write_depth(folder / f"{frame.index:06}.png", depth)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("camera", choices=["realsense", "oak"])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--bag")
    parser.add_argument("--disparities", default="0:95")
    parser.add_argument("--max-depth", type=float)
    given = parser.parse_args()
    pairs, rig = open_realsense(given.bag) if given.camera == "realsense" else open_oak()
    write_depths(pairs, rig, given.folder, not given.bag, given.max_depth,
                 disparities=given.disparities)


if __name__ == "__main__":
    main()
