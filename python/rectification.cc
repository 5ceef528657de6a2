// Calibrations of cameras, and rectification of pairs.
#include "python/rectification.h"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/rig_scale.h"
#include "engine/vantage.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "python/options.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

using Matrix = Eigen::Matrix3d;
using Size = std::optional<std::pair<int, int>>;

StereoCalibration make_calibration(const Matrix& left, const std::vector<double>& left_distortion,
                                   const std::optional<Matrix>& right,
                                   const std::vector<double>& right_distortion,
                                   const Matrix& rotation,
                                   const std::optional<Eigen::Vector3d>& translation,
                                   const Size& image_size, bool is_rectified,
                                   std::optional<double> metres_per_unit) {
  if (metres_per_unit && !(*metres_per_unit > 0 && std::isfinite(*metres_per_unit))) {
    throw UsageError(
        fmt::format("metres_per_unit is {}, expected a number above 0", *metres_per_unit));
  }
  if (!translation) {
    throw UsageError("T is not given, expected x_right - R x_left, such as (-0.12, 0, 0)");
  }
  StereoCalibration calibration;
  calibration.file = "the calibration";
  calibration.metres_per_unit = metres_per_unit;
  calibration.left = {left, left_distortion};
  calibration.right = {right.value_or(left), right_distortion};
  calibration.rotation = rotation;
  calibration.translation = *translation;
  if (image_size) {
    calibration.image_size = {image_size->first, image_size->second};
  }
  calibration.is_rectified = is_rectified;
  calibration.validate();
  return calibration;
}

/// Rectified cameras of a rig of which little is known.
StereoCalibration make_rig(double focal_px, double baseline_metres, const Size& image_size,
                           double doffs_px, const std::optional<std::pair<double, double>>& point) {
  const apps::RigScale rig{
      .focal_length_px = focal_px, .baseline_m = baseline_metres, .doffs_px = doffs_px};
  rig.validate("");
  if (!image_size && !point) {
    throw UsageError(
        "image_size and principal_point_px are not given, expected one of them: the principal "
        "point is in the middle of the image unless it is given");
  }
  StereoCalibration calibration;
  const auto [cx, cy] = point.value_or(
      image_size ? std::pair((image_size->first - 1) / 2.0, (image_size->second - 1) / 2.0)
                 : std::pair(0.0, 0.0));
  calibration.left.matrix << focal_px, 0, cx, 0, focal_px, cy, 0, 0, 1;
  calibration.right.matrix = calibration.left.matrix;
  calibration.right.matrix(0, 2) += doffs_px;
  calibration.translation = {-baseline_metres, 0, 0};
  if (image_size) {
    calibration.image_size = {image_size->first, image_size->second};
  }
  calibration.is_rectified = true;
  calibration.metres_per_unit = 1;
  calibration.file = "the calibration";
  calibration.validate();
  return calibration;
}

StereoCalibration load_calibration(const py::object& path, bool already_rectified,
                                   const std::optional<std::array<int, 2>>& kitti_cameras,
                                   const std::vector<py::object>& images) {
  std::optional<KittiCameras> cameras;
  if (kitti_cameras) {
    if (kitti_cameras != std::array{0, 1} && kitti_cameras != std::array{2, 3}) {
      throw UsageError(fmt::format("kitti_cameras is ({}, {}), expected (0, 1) or (2, 3)",
                                   (*kitti_cameras)[0], (*kitti_cameras)[1]));
    }
    cameras = kitti_cameras == std::array{0, 1} ? KittiCameras::kGrey : KittiCameras::kColour;
  }
  apps::RigScale rig;
  rig.images_are_rectified = already_rectified;
  const std::string file = path_of(path);
  StereoCalibration calibration = without_gil([&] { return rig.read(file, cameras); });
  if (!cameras && calibration.has_other_cameras) {
    std::vector<std::filesystem::path> paths;
    for (const py::object& image : images) {
      paths.emplace_back(path_of(image));
    }
    if (const std::optional<KittiCameras> named = kitti_cameras_of(paths)) {
      return without_gil([&] { return rig.read(file, named); });
    }
    const std::string text = fmt::format(
        "{}: has KITTI's cameras 0 to 3, and 0 and 1 (grey) are used; kitti_cameras=(2, 3) of "
        "Calibration.load() for images of 2 and 3 (colour)",
        file);
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) {
      throw py::error_already_set();
    }
  }
  return calibration;
}

/// OpenCV's Q of rectified cameras: (x, y, d, 1) → homogeneous (X, Y, Z).
Eigen::Matrix4d reprojection(const StereoCalibration& calibration) {
  if (!calibration.is_rectified) {
    throw Error("the calibration is not one of rectified images, expected that of rectify()");
  }
  const Matrix& k = calibration.left.matrix;
  Eigen::Matrix4d q = Eigen::Matrix4d::Zero();
  q(0, 0) = 1;
  q(0, 3) = -k(0, 2);
  q(1, 1) = k(0, 0) / k(1, 1);
  q(1, 3) = -k(1, 2) * q(1, 1);
  q(2, 3) = k(0, 0);
  q(3, 2) = 1 / calibration.baseline();
  q(3, 3) = calibration.doffs_px() / calibration.baseline();
  return q;
}

struct RectifiedImages {
  Photograph left;
  Photograph right;
  StereoCalibration calibration;
  StereoCalibration cameras;  ///< of the given images
  std::optional<double> row_error_px;
  PixelRectangle valid;
};

RectifiedImages rectify(const Photograph& left, const Photograph& right,
                        const std::optional<StereoCalibration>& given,
                        const RectificationOptions& options, Execution& execution) {
  const int width = left.width();
  const int height = left.height();
  if (right.width() != width || right.height() != height) {
    throw Error(
        fmt::format("the left image has {}x{} pixels and the right one {}x{}, expected "
                    "equal sizes",
                    width, height, right.width(), right.height()));
  }
  Rectification rectification;
  if (given) {
    rectification.calibration = *given;
  } else {
    rectification.matches = match_features(left, right);
    rectification.estimate = estimate_rig(rectification.matches, width, height);
    rectification.calibration = rectification.estimate->calibration;
  }
  Rectifier rectifier(rectification.calibration, width, height, options);
  RectifiedImages result;
  const auto apply = [&] {
    rectifier.apply(left, Side::kLeft, result.left, execution);
    rectifier.apply(right, Side::kRight, result.right, execution);
  };
  apply();
  if (!given) {
    const std::vector<PointMatch> found = match_features(result.left, result.right);
    rectification.remaining = vertical_error(found);
    improve_rectification(rectification, rectifier, found, options);
    require_success(rectification, found.size(), "left and right");
    result.row_error_px = rectification.remaining->rms_px;
    apply();
  }
  result.cameras = rectification.calibration;
  result.calibration = rectified_calibration(rectifier.pair(), result.cameras);
  result.valid = rectifier.pair().valid;
  return result;
}

py::tuple to_rectify(const py::object& left, const py::object& right,
                     const std::optional<StereoCalibration>& calibration, double kept_outline,
                     bool bgr, py::dict keywords) {
  Execution& execution = take_execution(keywords);
  apps::Settings none("", "");
  set_options(none, keywords);
  const RectificationOptions options{kept_outline};
  options.validate();
  const ChannelOrder order = bgr ? ChannelOrder::kBgr : ChannelOrder::kRgb;
  const PixelArray left_pixels(left, order, "left");
  const PixelArray right_pixels(right, order, "right");
  RectifiedImages result = without_gil([&] {
    return rectify(left_pixels.copy(), right_pixels.copy(), calibration, options, execution);
  });
  return py::make_tuple(
      array_of(std::move(result.left), order), array_of(std::move(result.right), order),
      result.calibration, result.cameras, result.row_error_px,
      py::make_tuple(result.valid.x, result.valid.y, result.valid.width, result.valid.height));
}

constexpr const char* kCalibrationText =
    "Two cameras. K1, K2, R, T and D1, D2 as OpenCV has them: x_right = R x_left + T. K2 is "
    "K1\nunless "
    "given; T must be.\n\n"
    "image_size: (width, height) of both images. rectified: whether their rows correspond.\n"
    "metres_per_unit: length of the unit of T; None: not known. Raises Error for impossible "
    "cameras.";
constexpr const char* kLoadText =
    "Reads a file of OpenCV, Middlebury or KITTI. Raises Error.\n\nalready_rectified: the images "
    "were rectified with it: its P1 and P2, or Q, instead of M1 and M2.\nkitti_cameras: (0, 1), "
    "grey, or (2, 3), colour, of a KITTI file; None: those of the folders\n"
    "that `images` are in (image_2, image_3 ...), else (0, 1), with a warning if it has both.";
constexpr const char* kFocalLengthText =
    "Rectified cameras, in metres, of their focal length and distance.\n\ndoffs_px: cx of the "
    "right "
    "image minus cx of the left one. principal_point_px: (cx, cy) of the left\nimage; default: the "
    "middle of image_size, (width, height). One of both must be given.";
constexpr const char* kDepthMatrixText =
    "Rectified cameras of OpenCV's 4x4 matrix Q, in its unit. Raises Error for another matrix.";

}  // namespace

StereoCalibration rectified_calibration(const RectifiedPair& pair,
                                        const StereoCalibration& cameras) {
  StereoCalibration calibration;
  calibration.left.matrix = pair.left.matrix;
  calibration.right.matrix = pair.right.matrix;
  calibration.translation = {-pair.baseline, 0, 0};
  calibration.image_size = {pair.width_px, pair.height_px};
  calibration.is_rectified = true;
  calibration.format = "rectified calibration";
  calibration.file = cameras.file;
  calibration.metres_per_unit = cameras.metres_per_unit;
  calibration.has_scale = cameras.has_scale;
  return calibration;
}

std::optional<StereoCalibration> calibration_from(const py::object& object) {
  if (object.is_none()) {
    return std::nullopt;
  }
  if (py::isinstance<StereoCalibration>(object)) {
    return object.cast<StereoCalibration>();
  }
  return load_calibration(object, false, std::nullopt, {});
}

void bind_rectification(py::module_& module) {
  py::class_<StereoCalibration>(module, "Calibration", kCalibrationText)
      .def(py::init(&make_calibration), py::arg("K1"), py::arg("D1") = std::vector<double>(),
           py::arg("K2") = std::optional<Matrix>(), py::arg("D2") = std::vector<double>(),
           py::arg("R") = Matrix(Matrix::Identity()),
           py::arg("T") = std::optional<Eigen::Vector3d>(), py::kw_only(),
           py::arg("image_size") = Size(), py::arg("rectified") = false,
           py::arg("metres_per_unit") = std::optional<double>())
      .def_static("load", &load_calibration, py::arg("path"), py::kw_only(),
                  py::arg("already_rectified") = false, py::arg("kitti_cameras") = py::none(),
                  py::arg("images") = std::vector<py::object>(), kLoadText)
      .def_static("from_focal_length", &make_rig, py::arg("focal_px"), py::arg("baseline_metres"),
                  py::kw_only(), py::arg("image_size") = Size(), py::arg("doffs_px") = 0.0,
                  py::arg("principal_point_px") = std::optional<std::pair<double, double>>(),
                  kFocalLengthText)
      .def_static(
          "from_depth_matrix",
          [](const Eigen::Matrix4d& q) {
            StereoCalibration calibration = calibration_of_depth_matrix(q);
            calibration.validate();
            return calibration;
          },
          py::arg("Q"), kDepthMatrixText)
      .def_property_readonly(
          "K1", [](const StereoCalibration& c) { return c.left.matrix; },
          "float64, 3x3: camera matrix of the left image.")
      .def_property_readonly(
          "K2", [](const StereoCalibration& c) { return c.right.matrix; },
          "float64, 3x3: camera matrix of the right image.")
      .def_property_readonly(
          "D1", [](const StereoCalibration& c) { return c.left.distortion; },
          "Distortion of the left lens, OpenCV's coefficients; [] for none.")
      .def_property_readonly(
          "D2", [](const StereoCalibration& c) { return c.right.distortion; },
          "Distortion of the right lens, likewise.")
      .def_property_readonly(
          "R", [](const StereoCalibration& c) { return c.rotation; },
          "float64, 3x3: x_right = R x_left + T.")
      .def_property_readonly(
          "T", [](const StereoCalibration& c) { return c.translation; },
          "float64, 3: likewise, in the calibration's unit.")
      .def_property_readonly(
          "Q", &reprojection,
          "float64, 4x4: OpenCV's matrix of rectified cameras; Error for others.")
      .def_property_readonly(
          "image_size",
          [](const StereoCalibration& c) {
            return c.image_size ? Size({c.image_size->width_px, c.image_size->height_px}) : Size();
          },
          "(width, height) of both images; None: not known.")
      .def_property_readonly(
          "rectified", [](const StereoCalibration& c) { return c.is_rectified; },
          "Whether it is one of rectified images.")
      .def_property_readonly("baseline", &StereoCalibration::baseline,
                             "Distance of the cameras in the calibration's unit; 1 where they were "
                             "estimated from images.")
      .def_property_readonly("doffs", &StereoCalibration::doffs_px,
                             "cx of the right image minus cx of the left one, in pixels.")
      .def_property_readonly(
          "metres_per_unit", [](const StereoCalibration& c) { return c.metres_per_unit; },
          "Metres per unit of lengths; None: not known.")
      .def("__repr__", [](const StereoCalibration& c) {
        return fmt::format("<vantage.Calibration: {}, focal length {:.6g} px, baseline {:.6g}>",
                           c.is_rectified ? "rectified" : "not rectified", c.left.matrix(0, 0),
                           c.baseline());
      });
  module.def("rectify", &to_rectify);
}

}  // namespace vantage::python
