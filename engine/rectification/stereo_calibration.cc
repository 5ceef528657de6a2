#include "engine/rectification/stereo_calibration.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "engine/error.h"
#include "engine/io/photograph_io.h"

namespace vantage {
namespace {

/// R and t of a file with four significant digits still pass.
constexpr double kOrthonormalTolerance = 1e-3;
/// Rows of rectified images may be off by so much.
constexpr double kRowTolerancePx = 0.01;

void require_equal_in_rectified(const char* field, double left, double right) {
  if (!(std::abs(left - right) <= kRowTolerancePx)) {
    throw Error(
        fmt::format("the cameras are said to be rectified, but their {} is {} and {} pixels, "
                    "expected the same to {}",
                    field, left, right, kRowTolerancePx));
  }
}

}  // namespace

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
    throw Error(fmt::format("T has the length {}, expected a baseline of 1e-9 to 1e9", baseline()));
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
      throw Error("the right camera stands left of the left one, expected the cameras swapped");
    }
  }
}

void StereoCalibration::check_image_size(int width_px, int height_px) const {
  if (image_size && (image_size->width_px != width_px || image_size->height_px != height_px)) {
    throw Error(fmt::format("the images are {}x{}, but the calibration is of {}x{} images",
                            width_px, height_px, image_size->width_px, image_size->height_px));
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
  }
}

}  // namespace vantage
