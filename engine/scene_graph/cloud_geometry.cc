#include "engine/scene_graph/cloud_geometry.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vantage {

Eigen::Vector3d plane_around(const DisparityMap& map, int x0, int y0) {
  constexpr int kRadius_px = 2;
  const float centre = map.at(x0, y0);
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (int dy = -kRadius_px; dy <= kRadius_px; ++dy) {
    for (int dx = -kRadius_px; dx <= kRadius_px; ++dx) {
      const int x = x0 + dx;
      const int y = y0 + dy;
      if (x < 0 || x >= map.width() || y < 0 || y >= map.height()) {
        continue;
      }
      const float d = map.at(x, y);
      const auto steps = static_cast<float>(std::max(std::abs(dx), std::abs(dy)));
      if (std::abs(d - centre) <= kSurfaceLimit_px * std::max(steps, 1.0F)) {  // not with NaN
        const Eigen::Vector3d place(dx, dy, 1);
        products += place * place.transpose();
        right_side += static_cast<double>(d) * place;
      }
    }
  }
  Eigen::Vector3d plane(0, 0, static_cast<double>(centre));
  if (std::abs(products.determinant()) > 0.5) {  // whole numbers: 0 for pixels on one line
    plane = products.inverse() * right_side;
  }
  return plane;
}

float interpolated_disparity(ImageView<const float> map, double x, double y) {
  constexpr float kMaxStep_px = 1;
  const int left = std::min(static_cast<int>(x), std::max(map.width() - 2, 0));
  const int top = std::min(static_cast<int>(y), std::max(map.height() - 2, 0));
  const int right = std::min(left + 1, map.width() - 1);
  const int bottom = std::min(top + 1, map.height() - 1);
  const std::array<float, 4> around = {map.at(left, top), map.at(right, top), map.at(left, bottom),
                                       map.at(right, bottom)};
  const auto [min, max] = std::minmax_element(around.begin(), around.end());
  const bool are_finite =
      std::all_of(around.begin(), around.end(), [](float d) { return std::isfinite(d); });
  const auto along = static_cast<float>(x - left);
  const auto down = static_cast<float>(y - top);
  if (!are_finite || *max - *min > kMaxStep_px) {
    const float nearest = map.at(along < 0.5F ? left : right, down < 0.5F ? top : bottom);
    return std::isfinite(nearest) ? nearest : std::numeric_limits<float>::quiet_NaN();
  }
  return (1 - down) * ((1 - along) * around[0] + along * around[1]) +
         down * ((1 - along) * around[2] + along * around[3]);
}

}  // namespace vantage
