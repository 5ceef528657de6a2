#include "engine/rectification/rectified_positions.h"

#include <limits>

namespace vantage {
namespace {

/// Deviation up to which a patch counts as bilinear; small against half a pixel, which changes the
/// nearest pixel.
constexpr double kLargestBend = 0.03;  // px

}  // namespace

RectifiedPositions::RectifiedPositions(const Rectifier& rectifier, Side side)
    : rectifier_(rectifier),
      side_(side),
      patches_(static_cast<std::size_t>((rectifier.pair().width_px - 1) / kPatchPx + 1)) {}

Eigen::Vector2d RectifiedPositions::exact(double x, double y) const {
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  return rectifier_.rectified_position(side_, {x, y}).value_or(Eigen::Vector2d::Constant(kNowhere));
}

void RectifiedPositions::make_patches() {
  const double top = kPatchPx * row_;
  Eigen::Vector2d upper_right = exact(0, top);
  Eigen::Vector2d lower_right = exact(0, top + kPatchPx);
  double left = 0;
  for (Patch& patch : patches_) {
    patch.corners[0] = upper_right;
    patch.corners[2] = lower_right;
    upper_right = exact(left + kPatchPx, top);
    lower_right = exact(left + kPatchPx, top + kPatchPx);
    patch.corners[1] = upper_right;
    patch.corners[3] = lower_right;
    const Eigen::Vector2d centre = exact(left + kPatchPx / 2.0, top + kPatchPx / 2.0);
    patch.is_smooth = (patch.position(0.5, 0.5) - centre).norm() <= kLargestBend;  // false for NaN
    left += kPatchPx;
  }
}

}  // namespace vantage
