#include "engine/scene_graph/posed_pair.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/scene_graph/cloud_geometry.h"

namespace vantage {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kRectifiedTolerance = 1e-12;

/// Whether rows of the photographs correspond as they are.
bool is_rectified(const StereoCalibration& calibration) {
  Eigen::Matrix3d difference = calibration.left.matrix - calibration.right.matrix;
  difference(0, 2) = 0;
  const Eigen::Vector3d direction = calibration.translation.normalized();
  return difference.isZero(0) && calibration.left.is_without_distortion() &&
         calibration.right.is_without_distortion() &&
         calibration.left.matrix(0, 2) == calibration.right.matrix(0, 2) &&
         calibration.rotation.isIdentity(kRectifiedTolerance) &&
         (direction + Eigen::Vector3d::UnitX()).norm() <= kRectifiedTolerance;
}

StereoCalibration with_rectified_ones_marked(StereoCalibration calibration) {
  calibration.is_rectified = is_rectified(calibration);
  return calibration;
}

/// Halfway between what both cameras see and what either sees: views need the outer parts, too, and
/// photographs are not black where their own pixels are brought back.
constexpr RectificationOptions kAnyDirection = {.kept_outline = 0.5, .any_direction = true};

}  // namespace

PosedPair::PosedPair(const StereoCalibration& calibration, int width_px, int height_px,
                     Execution& execution)
    : calibration_(with_rectified_ones_marked(calibration)),
      width_px_(width_px),
      height_px_(height_px),
      rectifier_(calibration_, width_px, height_px, kAnyDirection),
      execution_(&execution) {}

std::array<Photograph, 2> PosedPair::rectified(const std::array<Photograph, 2>& photographs) const {
  std::array<Photograph, 2> result;
  rectifier_.apply(photographs[0], Side::kLeft, result[0], *execution_);
  rectifier_.apply(photographs[1], Side::kRight, result[1], *execution_);
  return result;
}

MatchedMap PosedPair::on_photograph(Side side, const MatchedMap& map, double scale_px) const {
  const RectifiedPair& pair = rectifier_.pair();
  const RectifiedCamera& camera = pair.camera(side);
  const Camera& lens = side == Side::kLeft ? calibration_.left : calibration_.right;
  // Depth in the photograph's camera = depth in the rectified one / Z of the turned ray (X, Y, 1).
  const Eigen::Matrix3d ray_of = camera.rotation * lens.matrix.inverse();
  const double scale = scale_px / focal_length_px();
  MatchedMap result;
  result.disparity_px.resize(width_px_, height_px_);
  result.unmatched.resize(width_px_, height_px_);
  execution_->for_each_row(height_px_, [&](int y) {
    for (int x = 0; x < width_px_; ++x) {
      float& disparity_px = result.disparity_px.at(x, y);
      std::uint8_t& unmatched = result.unmatched.at(x, y);
      disparity_px = kUnknown;
      unmatched = 255;
      const Eigen::Vector3d ray = ray_of * Eigen::Vector3d(x, y, 1);
      const Eigen::Vector2d at = (camera.matrix * ray).hnormalized();
      if (!(ray.z() > 0 && at.x() >= 0 && at.x() <= pair.width_px - 1 && at.y() >= 0 &&
            at.y() <= pair.height_px - 1)) {
        continue;
      }
      const float d = interpolated_disparity(map.disparity_px.view(), at.x(), at.y());
      if (std::isfinite(d)) {
        disparity_px = static_cast<float>(std::max(double{d}, 0.0) * ray.z() * scale);
        unmatched =
            map.unmatched.at(static_cast<int>(at.x() + 0.5), static_cast<int>(at.y() + 0.5));
      }
    }
  });
  return result;
}

}  // namespace vantage
