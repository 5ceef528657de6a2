// Calibrations of cameras, and rectification of pairs.
#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

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
                                   const Matrix& right, const std::vector<double>& right_distortion,
                                   const Matrix& rotation, const Eigen::Vector3d& translation,
                                   const Size& image_size, bool is_rectified) {
  StereoCalibration calibration;
  calibration.left = {left, left_distortion};
  calibration.right = {right, right_distortion};
  calibration.rotation = rotation;
  calibration.translation = translation;
  if (image_size) {
    calibration.image_size = {image_size->first, image_size->second};
  }
  calibration.is_rectified = is_rectified;
  calibration.validate();
  return calibration;
}

/// Calibration of the rectified images.
StereoCalibration calibration_of(const RectifiedPair& pair) {
  StereoCalibration calibration;
  calibration.left.matrix = pair.left.matrix;
  calibration.right.matrix = pair.right.matrix;
  calibration.translation = {-pair.baseline, 0, 0};
  calibration.image_size = {pair.width_px, pair.height_px};
  calibration.is_rectified = true;
  calibration.format = "rectified calibration";
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
  result.calibration = calibration_of(rectifier.pair());
  result.cameras = rectification.calibration;
  result.calibration.metres_per_unit = result.cameras.metres_per_unit;
  result.calibration.has_scale = result.cameras.has_scale;
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

}  // namespace

void bind_rectification(py::module_& module) {
  py::class_<StereoCalibration>(module, "Calibration")
      .def(py::init(&make_calibration), py::arg("K1"), py::arg("D1") = std::vector<double>(),
           py::arg("K2"), py::arg("D2") = std::vector<double>(),
           py::arg("R") = Matrix(Matrix::Identity()), py::arg("T"), py::kw_only(),
           py::arg("image_size") = Size(), py::arg("rectified") = false)
      .def_static("load",
                  [](const py::object& path) {
                    const auto file =
                        py::module_::import("os").attr("fspath")(path).cast<std::string>();
                    return without_gil([&] { return read_stereo_calibration(file); });
                  })
      .def_property_readonly("K1", [](const StereoCalibration& c) { return c.left.matrix; })
      .def_property_readonly("K2", [](const StereoCalibration& c) { return c.right.matrix; })
      .def_property_readonly("D1", [](const StereoCalibration& c) { return c.left.distortion; })
      .def_property_readonly("D2", [](const StereoCalibration& c) { return c.right.distortion; })
      .def_property_readonly("R", [](const StereoCalibration& c) { return c.rotation; })
      .def_property_readonly("T", [](const StereoCalibration& c) { return c.translation; })
      .def_property_readonly("Q", &reprojection)
      .def_property_readonly(
          "image_size",
          [](const StereoCalibration& c) {
            return c.image_size ? Size({c.image_size->width_px, c.image_size->height_px}) : Size();
          })
      .def_property_readonly("rectified", [](const StereoCalibration& c) { return c.is_rectified; })
      .def_property_readonly("baseline", &StereoCalibration::baseline)
      .def_property_readonly("doffs", &StereoCalibration::doffs_px)
      .def_property_readonly("metres_per_unit",
                             [](const StereoCalibration& c) { return c.metres_per_unit; })
      .def("__repr__", [](const StereoCalibration& c) {
        return fmt::format("<vantage.Calibration: {}, focal length {:.6g} px, baseline {:.6g}>",
                           c.is_rectified ? "rectified" : "not rectified", c.left.matrix(0, 0),
                           c.baseline());
      });
  module.def("rectify", &to_rectify);
}

}  // namespace vantage::python
