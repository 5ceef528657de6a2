#include "engine/view_geometry/posed_camera.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr int kLargestCameraSide = 16384;
constexpr double kRotationTolerance = 1e-6;
constexpr double kMinFocal_px = 0.001;
constexpr double kLargestFocal_px = 1e7;

}  // namespace

void PosedCamera::validate(const std::string& name) const {
  if (width_px < 1 || height_px < 1 || width_px > kLargestCameraSide ||
      height_px > kLargestCameraSide) {
    throw Error(fmt::format("{}: image is {}×{}, expected 1 to {} pixels each way", name, width_px,
                            height_px, kLargestCameraSide));
  }
  if (!matrix.allFinite() || !rotation.allFinite() || !translation.allFinite()) {
    throw Error(fmt::format("{}: K, R or t holds a value that is not finite", name));
  }
  const double min = std::min(matrix(0, 0), matrix(1, 1));
  const double largest = std::max(matrix(0, 0), matrix(1, 1));
  if (!(min >= kMinFocal_px && largest <= kLargestFocal_px)) {
    throw Error(fmt::format("{}: focal lengths are {} and {} px, expected {} to {:g}", name,
                            matrix(0, 0), matrix(1, 1), kMinFocal_px, kLargestFocal_px));
  }
  if (matrix(1, 0) != 0 || matrix(2, 0) != 0 || matrix(2, 1) != 0 || matrix(2, 2) != 1) {
    throw Error(
        fmt::format("{}: K is not upper triangular with 1 at its end, expected rows "
                    "(fx, skew, cx), (0, fy, cy), (0, 0, 1)",
                    name));
  }
  const double deviation =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (deviation > kRotationTolerance) {
    throw Error(fmt::format("{}: R Rᵀ differs from the identity by {:.3g}, expected at most {}",
                            name, deviation, kRotationTolerance));
  }
  if (rotation.determinant() < 0) {
    throw Error(fmt::format("{}: R is mirrored (determinant −1), expected a rotation", name));
  }
}

}  // namespace vantage
