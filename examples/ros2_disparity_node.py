"""A ROS 2 node in the place of the disparity and point cloud nodes of stereo_image_proc.

    python3 ros2_disparity_node.py --ros-args -r __ns:=/stereo -p disparities:=0:95

It subscribes to left/image_rect, left/camera_info, right/image_rect and right/camera_info, and
publishes disparity (stereo_msgs/DisparityImage) and points2 (sensor_msgs/PointCloud2) with the
header of the left image. The functions need no ROS: they read and fill messages by their fields.
"""

import array
import sys

import numpy as np

import vantage

# Encodings of sensor_msgs/Image: type of a value, channels, whether blue is first.
ENCODINGS = {"mono8": (np.uint8, 1, False), "8UC1": (np.uint8, 1, False),
             "mono16": (np.uint16, 1, False), "16UC1": (np.uint16, 1, False),
             "rgb8": (np.uint8, 3, False), "bgr8": (np.uint8, 3, True),
             "rgba8": (np.uint8, 4, False), "bgra8": (np.uint8, 4, True),
             "rgb16": (np.uint16, 3, False), "bgr16": (np.uint16, 3, True)}
FLOAT32 = 7  # sensor_msgs/PointField


def image_of(message):
    """The pixels of a sensor_msgs/Image: HxW, or HxWx3 in RGB order; uint8 or uint16."""
    if message.encoding not in ENCODINGS:
        raise ValueError(f"encoding is '{message.encoding}', expected one of {[*ENCODINGS]}")
    kind, channels, is_bgr = ENCODINGS[message.encoding]
    stored = np.dtype(kind).newbyteorder(">" if message.is_bigendian else "<")
    pixels = np.ndarray((message.height, message.width, channels), stored, bytes(message.data),
                        strides=(message.step, channels * stored.itemsize, stored.itemsize))
    if channels == 1:
        return pixels[..., 0].astype(kind)
    return pixels[..., [2, 1, 0] if is_bgr else [0, 1, 2]].astype(kind)


def projection_of(info):
    """P (3x4) of a sensor_msgs/CameraInfo, for the pixels of the image that was sent."""
    projection = np.array(info.p, float).reshape(3, 4)
    if not projection[0, 0] > 0:
        raise ValueError("P of camera_info is 0: the camera is not calibrated")
    projection[0] -= info.roi.x_offset * projection[2]
    projection[1] -= info.roi.y_offset * projection[2]
    projection[0] /= max(info.binning_x, 1)
    projection[1] /= max(info.binning_y, 1)
    return projection


def rig_of(left_info, right_info, image):
    """The vantage.Calibration, in metres, of rectified cameras whose left image is `image`."""
    left, right = projection_of(left_info), projection_of(right_info)
    baseline_m = -right[0, 3] / right[0, 0]
    if not baseline_m > 0:
        raise ValueError(f"the right camera is at {baseline_m:g} m, expected above 0: to the right")
    return vantage.Calibration(K1=left[:, :3], K2=right[:, :3], T=[-baseline_m, 0, 0],
                               image_size=image.shape[1::-1], rectified=True, metres_per_unit=1)


def fill_image(message, header, pixels):
    """Fills a sensor_msgs/Image with float32 pixels, HxW."""
    message.header = header
    message.height, message.width = pixels.shape
    message.encoding, message.is_bigendian, message.step = "32FC1", 0, 4 * pixels.shape[1]
    message.data = array.array("B", pixels.astype("<f4").tobytes())


def fill_disparity(message, header, result, rig):
    """Fills a stereo_msgs/DisparityImage: d = x_l - x_r - (cx_l - cx_r), so that Z = f t / d.

    Unknown disparities are less than min_disparity.
    """
    low, high = (edge + rig.doffs for edge in result.disparities)
    disparity = result.disparity.astype(float) + rig.doffs
    fill_image(message.image, header, np.where(np.isnan(disparity), low - 1, disparity))
    message.header = header
    message.f, message.t = float(rig.K1[0, 0]), rig.baseline
    message.min_disparity, message.max_disparity = float(low), float(high)
    message.delta_d = 1 / 16  # parts of a pixel that a match can tell apart
    window = message.valid_window  # all of the image can have disparities
    window.x_offset = window.y_offset = 0
    window.height, window.width = disparity.shape
    window.do_rectify = False


def fill_points(message, make_field, header, result, rig, colours):
    """Fills a sensor_msgs/PointCloud2: a point per pixel, in metres, NaN where unknown.

    make_field: sensor_msgs/PointField. colours: the left image, as image_of() gives it.
    """
    cloud = np.zeros(result.disparity.shape, [("xyz", "<f4", 3), ("rgb", "<u4")])
    cloud["xyz"] = vantage.reproject(result.disparity, rig)
    colours = (colours >> 8 if colours.dtype == np.uint16 else colours).astype(np.uint32)
    if colours.ndim == 2:
        colours = np.repeat(colours[..., None], 3, axis=2)
    cloud["rgb"] = colours[..., 0] << 16 | colours[..., 1] << 8 | colours[..., 2]
    message.header = header
    message.height, message.width = cloud.shape
    message.fields = [make_field(name=name, offset=4 * number, datatype=FLOAT32, count=1)
                      for number, name in enumerate(["x", "y", "z", "rgb"])]
    message.is_bigendian, message.is_dense = False, False
    message.point_step, message.row_step = cloud.itemsize, cloud.itemsize * cloud.shape[1]
    message.data = array.array("B", cloud.tobytes())


def main():
    import message_filters
    import rclpy
    from rclpy.qos import qos_profile_sensor_data
    from sensor_msgs.msg import CameraInfo, Image, PointCloud2, PointField
    from stereo_msgs.msg import DisparityImage

    rclpy.init(args=sys.argv)
    node = rclpy.create_node("vantage_disparity")
    options = {name: node.declare_parameter(name, value).value for name, value in
               [("preset", "realtime"), ("disparities", "0:127"), ("fill", "none")]}
    matcher = vantage.Matcher(**options)
    disparities = node.create_publisher(DisparityImage, "disparity", 1)
    clouds = node.create_publisher(PointCloud2, "points2", 1)

    def match(left, left_info, right, right_info):
        image = image_of(left)
        rig = rig_of(left_info, right_info, image)
        result = matcher.compute(image, image_of(right))
        disparity, points = DisparityImage(), PointCloud2()
        fill_disparity(disparity, left.header, result, rig)
        disparities.publish(disparity)
        if clouds.get_subscription_count():
            fill_points(points, PointField, left.header, result, rig, image)
            clouds.publish(points)

    topics = [(kind, f"{side}/{name}") for side in ["left", "right"]
              for kind, name in [(Image, "image_rect"), (CameraInfo, "camera_info")]]
    subscribers = [message_filters.Subscriber(node, *topic, qos_profile=qos_profile_sensor_data)
                   for topic in topics]
    message_filters.TimeSynchronizer(subscribers, 2).registerCallback(match)
    rclpy.spin(node)


if __name__ == "__main__":
    main()
