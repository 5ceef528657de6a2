#include "engine/scene_graph/interpolated_disparity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vantage {

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
