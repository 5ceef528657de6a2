// Calibrations of cameras.
#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/options/rig_scale.h"
#include "engine/vantage.h"
#include "python/arrays.h"
#include "python/calls.h"
#include "python/remark_warnings.h"

namespace vantage::python {
namespace py = pybind11;
namespace {

using Matrix = Eigen::Matrix3d;
using Size = std::optional<std::pair<int, int>>;

/// A calibration of arguments is invalid for any data.
void validate(const StereoCalibration& calibration) {
  try {
    calibration.validate();
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

/// Numbers as an array of float64, row after row. Throws UsageError that starts with `name`.
py::array_t<double> numbers_of(const py::object& object, const char* name, const char* expected) {
  using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const py::array array = py::array::ensure(object);
  if (!array ||
      (array.size() > 0 && std::string("fiu").find(array.dtype().kind()) == std::string::npos)) {
    PyErr_Clear();
    throw UsageError(fmt::format("{} is of type {}, expected {}", name,
                                 std::string(py::str(py::type::of(object).attr("__name__"))),
                                 expected));
  }
  return Numbers(array);
}

Matrix matrix_of(const py::object& object, const char* name) {
  const py::array_t<double> numbers = numbers_of(object, name, "3x3 numbers");
  if (numbers.ndim() != 2 || numbers.shape(0) != 3 || numbers.shape(1) != 3) {
    throw UsageError(fmt::format("{} has the shape {}, expected 3x3", name, shape_text(numbers)));
  }
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
}

/// Of a row or a column, as OpenCV has them.
std::vector<double> vector_of(const py::object& object, const char* name) {
  const py::array_t<double> numbers = numbers_of(object, name, "a row of numbers");
  py::ssize_t longest = numbers.ndim() == 0 ? 0 : 1;
  for (py::ssize_t i = 0; i < numbers.ndim(); ++i) {
    longest = std::max(longest, numbers.shape(i));
  }
  if (numbers.ndim() == 0 || (numbers.size() > 0 && longest != numbers.size())) {
    throw UsageError(
        fmt::format("{} has the shape {}, expected a row of numbers", name, shape_text(numbers)));
  }
  return {numbers.data(), numbers.data() + numbers.size()};
}

std::optional<ImageSize> size_of(const py::object& object) {
  if (object.is_none()) {
    return std::nullopt;
  }
  try {
    const auto [width, height] = object.cast<std::pair<int, int>>();
    return ImageSize{width, height};
  } catch (const py::cast_error&) {
    throw UsageError(fmt::format("image_size is {}, expected (width, height) in whole pixels",
                                 std::string(py::repr(object))));
  }
}

LensKind lens_of(const std::string& name) {
  if (name != "standard" && name != "fisheye") {
    throw UsageError(fmt::format("lens is '{}', expected 'standard' or 'fisheye'", name));
  }
  return name == "fisheye" ? LensKind::kFisheye : LensKind::kStandard;
}

StereoCalibration make_calibration(const py::object& left, const py::object& left_distortion,
                                   const py::object& right, const py::object& right_distortion,
                                   const py::object& rotation, const py::object& translation,
                                   const py::object& image_size, bool is_rectified,
                                   std::optional<double> metres_per_unit, const std::string& lens) {
  if (metres_per_unit && !(*metres_per_unit > 0 && std::isfinite(*metres_per_unit))) {
    throw UsageError(
        fmt::format("metres_per_unit is {}, expected a number above 0", *metres_per_unit));
  }
  if (translation.is_none()) {
    throw UsageError("T is not given, expected x_right - R x_left, such as (-0.12, 0, 0)");
  }
  const std::vector<double> position = vector_of(translation, "T");
  if (position.size() != 3) {
    throw UsageError(fmt::format("T has {} numbers, expected 3", position.size()));
  }
  const auto distortion = [](const py::object& given, const char* name) {
    return given.is_none() ? std::vector<double>() : vector_of(given, name);
  };
  StereoCalibration calibration;
  calibration.file = "the calibration";
  calibration.metres_per_unit = metres_per_unit;
  calibration.left = {matrix_of(left, "K1"), distortion(left_distortion, "D1"), lens_of(lens)};
  calibration.right = {right.is_none() ? calibration.left.matrix : matrix_of(right, "K2"),
                       distortion(right_distortion, "D2"), lens_of(lens)};
  if (!rotation.is_none()) {
    calibration.rotation = matrix_of(rotation, "R");
  }
  calibration.translation = Eigen::Vector3d(position.data());
  calibration.image_size = size_of(image_size);
  calibration.is_rectified = is_rectified;
  validate(calibration);
  return calibration;
}

StereoCalibration of_depth_matrix(const py::object& object) {
  const py::array_t<double> numbers = numbers_of(object, "Q", "4x4 numbers");
  if (numbers.ndim() != 2 || numbers.shape(0) != 4 || numbers.shape(1) != 4) {
    throw UsageError(fmt::format("Q has the shape {}, expected 4x4", shape_text(numbers)));
  }
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> q(numbers.data());
  if (!q.allFinite()) {
    throw UsageError("Q has values that are not finite numbers");
  }
  try {
    StereoCalibration calibration = calibration_of_depth_matrix(q);
    calibration.validate();
    return calibration;
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

/// Rectified cameras of a rig of which little is known.
StereoCalibration make_rig(double focal_px, double baseline_metres, const py::object& given_size,
                           double doffs_px, const std::optional<std::pair<double, double>>& point) {
  const RigScale rig{
      .focal_length_px = focal_px, .baseline_m = baseline_metres, .doffs_px = doffs_px};
  rig.validate("");
  const std::optional<ImageSize> size = size_of(given_size);
  if (!size && !point) {
    throw UsageError(
        "image_size and principal_point_px are not given, expected one of them: the principal "
        "point is in the middle of the image unless it is given");
  }
  StereoCalibration calibration;
  const auto [cx, cy] =
      point.value_or(size ? std::pair((size->width_px - 1) / 2.0, (size->height_px - 1) / 2.0)
                          : std::pair(0.0, 0.0));
  calibration.left.matrix << focal_px, 0, cx, 0, focal_px, cy, 0, 0, 1;
  calibration.right.matrix = calibration.left.matrix;
  calibration.right.matrix(0, 2) += doffs_px;
  calibration.translation = {-baseline_metres, 0, 0};
  calibration.image_size = size;
  calibration.is_rectified = true;
  calibration.metres_per_unit = 1;
  calibration.file = "the calibration";
  validate(calibration);
  return calibration;
}

StereoCalibration load_calibration(const py::object& path, bool already_rectified,
                                   const std::optional<std::array<int, 2>>& kitti_cameras,
                                   const std::vector<py::object>& images,
                                   const std::optional<std::string>& lens) {
  CalibrationChoice choice;
  std::optional<KittiCameras>& cameras = choice.kitti_cameras;
  if (lens) {
    choice.lens = lens_of(*lens);
  }
  if (kitti_cameras) {
    if (kitti_cameras != std::array{0, 1} && kitti_cameras != std::array{2, 3}) {
      throw UsageError(fmt::format("kitti_cameras is ({}, {}), expected (0, 1) or (2, 3)",
                                   (*kitti_cameras)[0], (*kitti_cameras)[1]));
    }
    cameras = kitti_cameras == std::array{0, 1} ? KittiCameras::kGrey : KittiCameras::kColour;
  }
  RigScale rig;
  rig.images_are_rectified = already_rectified;
  const std::string file = path_of(path);
  StereoCalibration calibration = without_gil([&] { return rig.read(file, choice); });
  RemarkWarnings().warn(calibration.remarks);
  if (!cameras && calibration.has_other_cameras) {
    std::vector<std::filesystem::path> paths;
    for (const py::object& image : images) {
      paths.emplace_back(path_of(image));
    }
    if ((cameras = kitti_cameras_of(paths))) {
      return without_gil([&] { return rig.read(file, choice); });
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

/// Everything that a calibration holds, for pickle.
py::tuple state_of(const StereoCalibration& c) {
  return py::make_tuple(
      c.left.matrix, c.left.distortion, c.right.matrix, c.right.distortion, c.rotation,
      c.translation,
      c.image_size ? Size({c.image_size->width_px, c.image_size->height_px}) : Size(),
      c.metres_per_unit, c.has_scale, c.is_rectified,
      c.kitti_cameras ? std::optional(static_cast<int>(*c.kitti_cameras)) : std::nullopt,
      c.has_other_cameras, c.format, text_of(c.file), c.left.lens == LensKind::kFisheye,
      c.right.lens == LensKind::kFisheye);
}

StereoCalibration of_state(const py::tuple& state) {
  if (state.size() != 16) {
    throw UsageError("the pickled calibration is not of this version of vantage");
  }
  StereoCalibration c;
  c.left = {state[0].cast<Matrix>(), state[1].cast<std::vector<double>>()};
  c.right = {state[2].cast<Matrix>(), state[3].cast<std::vector<double>>()};
  c.rotation = state[4].cast<Matrix>();
  c.translation = state[5].cast<Eigen::Vector3d>();
  if (const Size size = state[6].cast<Size>()) {
    c.image_size = {size->first, size->second};
  }
  c.metres_per_unit = state[7].cast<std::optional<double>>();
  c.has_scale = state[8].cast<bool>();
  c.is_rectified = state[9].cast<bool>();
  if (const auto cameras = state[10].cast<std::optional<int>>()) {
    c.kitti_cameras = static_cast<KittiCameras>(*cameras);
  }
  c.has_other_cameras = state[11].cast<bool>();
  c.format = state[12].cast<std::string>();
  c.file = bytes_of(state[13]);
  c.left.lens = state[14].cast<bool>() ? LensKind::kFisheye : LensKind::kStandard;
  c.right.lens = state[15].cast<bool>() ? LensKind::kFisheye : LensKind::kStandard;
  validate(c);
  return c;
}

constexpr const char* kCalibrationText =
    "Two cameras. K1, K2, R, T and D1, D2 as OpenCV has them: x_right = R x_left + T. K2 is "
    "K1\nunless "
    "given; T must be.\n\n"
    "image_size: (width, height) of both images. rectified: whether their rows correspond.\n"
    "metres_per_unit: length of the unit of T; None: not known. lens: 'standard', or 'fisheye' "
    "for\n"
    "D1 and D2 of cv2.fisheye. Raises "
    "UsageError for impossible cameras.";
constexpr const char* kLoadText =
    "Reads a file of OpenCV, ROS, Kalibr, EuRoC, ORB-SLAM, Middlebury, KITTI or COLMAP; "
    "'LEFT,RIGHT' "
    "for\ntwo files. Raises Error.\n\nalready_rectified: the images "
    "were rectified with it: its P1 and P2, or Q, instead of M1 and M2.\nkitti_cameras: (0, 1), "
    "grey, or (2, 3), colour, of a KITTI file; None: those of the folders\n"
    "that `images` are in (image_2, image_3 ...), else (0, 1), with a warning if it has "
    "both.\nlens: "
    "'standard' or 'fisheye', where four coefficients do not tell.";
constexpr const char* kFocalLengthText =
    "Rectified cameras, in metres, of their focal length and distance.\n\ndoffs_px: cx of the "
    "right "
    "image minus cx of the left one. principal_point_px: (cx, cy) of the left\nimage; default: the "
    "middle of image_size, (width, height). One of both must be given.";
constexpr const char* kDepthMatrixText =
    "Rectified cameras of OpenCV's 4x4 matrix Q, in its unit. Raises UsageError for another "
    "matrix.";

}  // namespace

std::optional<StereoCalibration> calibration_from(const py::object& object) {
  if (object.is_none()) {
    return std::nullopt;
  }
  if (py::isinstance<StereoCalibration>(object)) {
    return object.cast<StereoCalibration>();
  }
  return load_calibration(object, false, std::nullopt, {}, std::nullopt);
}

void bind_calibration(py::module_& module) {
  py::class_<StereoCalibration>(module, "Calibration", kCalibrationText)
      .def(py::init(&make_calibration), py::arg("K1"), py::arg("D1") = py::none(),
           py::arg("K2") = py::none(), py::arg("D2") = py::none(), py::arg("R") = py::none(),
           py::arg("T") = py::none(), py::kw_only(), py::arg("image_size") = py::none(),
           py::arg("rectified") = false, py::arg("metres_per_unit") = std::optional<double>(),
           py::arg("lens") = "standard")
      .def_static("load", &load_calibration, py::arg("path"), py::kw_only(),
                  py::arg("already_rectified") = false, py::arg("kitti_cameras") = py::none(),
                  py::arg("images") = std::vector<py::object>(),
                  py::arg("lens") = std::optional<std::string>(), kLoadText)
      .def_static("from_focal_length", &make_rig, py::arg("focal_px"), py::arg("baseline_metres"),
                  py::kw_only(), py::arg("image_size") = py::none(), py::arg("doffs_px") = 0.0,
                  py::arg("principal_point_px") = std::optional<std::pair<double, double>>(),
                  kFocalLengthText)
      .def_static("from_depth_matrix", &of_depth_matrix, py::arg("Q"), kDepthMatrixText)
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
          "lens",
          [](const StereoCalibration& c) {
            return c.left.lens == LensKind::kFisheye ? "fisheye" : "standard";
          },
          "'standard', or 'fisheye': D1 and D2 are those of cv2.fisheye.")
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
      .def(py::pickle(&state_of, &of_state))
      .def("__repr__", [](const StereoCalibration& c) {
        return fmt::format("<vantage.Calibration: {}, focal length {:.6g} px, baseline {:.6g}>",
                           c.is_rectified ? "rectified" : "not rectified", c.left.matrix(0, 0),
                           c.baseline());
      });
}

}  // namespace vantage::python
