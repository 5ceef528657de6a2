#include "engine/rectification/stereo_calibration.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"

namespace vantage {
namespace {

/// Accepts R and t of files with four significant digits.
constexpr double kOrthonormalTolerance = 1e-3;
/// Tolerance for corresponding rows of rectified images.
constexpr double kRowTolerancePx = 0.01;
/// Share of the baseline that may point up or forward in rectified pairs; KITTI's have half of it.
constexpr double kMaxOffAxis = 0.01;
constexpr double kMinFocalPerSide = 0.05;

void require_equal_in_rectified(const char* field, double left, double right) {
  if (!(std::abs(left - right) <= kRowTolerancePx)) {
    throw Error(
        fmt::format("the cameras are said to be rectified, but their {} is {} and {} pixels, "
                    "expected the same to {}",
                    field, left, right, kRowTolerancePx));
  }
}

}  // namespace

void StereoCalibration::set_baseline_m(double metres) {
  translation *= metres / baseline();
  metres_per_unit = 1;
  has_scale = true;
}

std::optional<Camera> SizedCamera::scaled_to(ImageSize other) const {
  const double x_scale = static_cast<double>(other.width_px) / size.width_px;
  const double y_scale = static_cast<double>(other.height_px) / size.height_px;
  constexpr double kLeastChange = 1.1;
  const bool is_known = size.width_px > 0 && size.height_px > 0;
  // The sides of the smaller size are whole pixels.
  const double off_px = std::abs(x_scale / y_scale - 1) *
                        std::min({size.width_px, size.height_px, other.width_px, other.height_px});
  if (!is_known || !(off_px <= 1) || std::max(x_scale, 1 / x_scale) < kLeastChange) {
    return std::nullopt;
  }
  Camera scaled = camera;
  scaled.matrix.row(0) *= x_scale;
  scaled.matrix.row(1) *= y_scale;
  // Pixel centres are at integers: the left edge, at −1/2, stays where it is.
  scaled.matrix(0, 2) += (x_scale - 1) / 2;
  scaled.matrix(1, 2) += (y_scale - 1) / 2;
  return scaled;
}

StereoCalibration StereoCalibration::for_images(int width_px, int height_px) const {
  StereoCalibration result = *this;
  if (!image_size || (image_size->width_px == width_px && image_size->height_px == height_px)) {
    return result;
  }
  const ImageSize size{width_px, height_px};
  const auto left_scaled = SizedCamera{left, *image_size}.scaled_to(size);
  const auto right_scaled = SizedCamera{right, *image_size}.scaled_to(size);
  if (left_scaled && right_scaled) {
    result.left = *left_scaled;
    result.right = *right_scaled;
    result.image_size = size;
    result.remarks.push_back(
        {.kind = Remark::Kind::kNote,
         .subject = "calibration",
         .text = fmt::format("{} is for images of {}x{} and is scaled to {}x{}",
                             file.empty() ? "the calibration" : file, image_size->width_px,
                             image_size->height_px, width_px, height_px)});
  }
  return result;
}

void StereoCalibration::validate() const {
  left.validate("left camera");
  right.validate("right camera");
  if (!rotation.allFinite() || !translation.allFinite()) {
    throw Error("R or T has values that are not finite numbers");
  }
  const double deviation =
      (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kOrthonormalTolerance)) {
    throw Error(
        fmt::format("R is not a rotation: its columns deviate from orthonormal by {:.3g}, "
                    "expected at most {}",
                    deviation, kOrthonormalTolerance));
  }
  if (rotation.determinant() < 0) {
    throw Error("R is mirrored: its determinant is -1, expected 1");
  }
  if (!(baseline() >= 1e-9 && baseline() <= 1e9)) {
    throw Error(
        fmt::format("the baseline (length of T) is {:.6g}, expected 1e-9 to 1e9", baseline()));
  }
  if (image_size) {
    const auto& [width, height] = *image_size;
    if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide) {
      throw Error(fmt::format("the image size is {}x{}, expected sides of 1 to {}", width, height,
                              kMaxImageSide));
    }
  }
  if (is_rectified) {
    require_equal_in_rectified("fx", left.matrix(0, 0), right.matrix(0, 0));
    require_equal_in_rectified("fy", left.matrix(1, 1), right.matrix(1, 1));
    require_equal_in_rectified("cy", left.matrix(1, 2), right.matrix(1, 2));
    if (translation.x() >= 0) {
      throw Error("the right camera is to the left of the left one, expected the cameras swapped");
    }
    const double off_axis = std::hypot(translation.y(), translation.z()) / baseline();
    if (!(off_axis <= kMaxOffAxis)) {
      throw Error(fmt::format(
          "the cameras are said to be rectified, but {:.3g} % of the baseline ({:.4g}, "
          "{:.4g}, {:.4g}) is not along x, expected at most {:g} %",
          100 * off_axis, -translation.x(), -translation.y(), -translation.z(), 100 * kMaxOffAxis));
    }
  }
}

void StereoCalibration::check_image_size(int width_px, int height_px) const {
  if (image_size && (image_size->width_px != width_px || image_size->height_px != height_px)) {
    const bool is_turned = image_size->width_px == height_px && image_size->height_px == width_px;
    throw Error(
        fmt::format("the images are {}x{}, but the calibration is for {}x{}{}", width_px, height_px,
                    image_size->width_px, image_size->height_px,
                    is_turned ? " (`orientation` stored leaves images as files hold them)" : ""));
  }
  for (const auto& [name, camera] : {std::pair{"left", &left}, {"right", &right}}) {
    const double cx = camera->matrix(0, 2);
    const double cy = camera->matrix(1, 2);
    if (!(cx >= 0 && cx <= width_px - 1 && cy >= 0 && cy <= height_px - 1)) {
      throw Error(fmt::format(
          "the {} camera's principal point ({:.6g}, {:.6g}) is outside of the {}x{} images: "
          "expected a calibration of images of this size",
          name, cx, cy, width_px, height_px));
    }
    for (const auto& [field, focal_px, side_px] : {std::tuple{"fx", camera->matrix(0, 0), width_px},
                                                   {"fy", camera->matrix(1, 1), height_px}}) {
      if (!(focal_px >= kMinFocalPerSide * side_px)) {
        throw Error(fmt::format(
            "the {} camera's {} is {:.6g} pixels, expected at least {:.6g} for {}x{} images", name,
            field, focal_px, kMinFocalPerSide * side_px, width_px, height_px));
      }
    }
  }
}

}  // namespace vantage
