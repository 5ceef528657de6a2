#include "engine/scene_graph/cloud_geometry.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

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

}  // namespace vantage
