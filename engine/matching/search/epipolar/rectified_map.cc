#include "engine/matching/search/epipolar/rectified_map.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace vantage {
namespace {

template <typename T>
void bring(const Rectifier& rectifier, Side side, T unknown, Execution& execution,
           Image<T>& image) {
  if (image.empty()) {
    return;
  }
  Image<T> result(image.width(), image.height());
  execution.for_each_band(image.height(), [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const auto at = rectifier.source_position(side, {x, y});
        const double column = at ? std::floor(at->x() + 0.5) : -1;
        const double row = at ? std::floor(at->y() + 0.5) : -1;
        const bool is_inside =
            column >= 0 && column < image.width() && row >= 0 && row < image.height();
        result.at(x, y) =
            is_inside ? image.at(static_cast<int>(column), static_cast<int>(row)) : unknown;
      }
    }
  });
  image = std::move(result);
}

}  // namespace

void bring_to_rectified(const Rectifier& rectifier, Side side, Execution& execution,
                        MatchedMap& map) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr std::uint8_t kUnmatched = 255;
  bring(rectifier, side, kNaN, execution, map.disparity_px);
  bring(rectifier, side, 0.0F, execution, map.confidence);
  bring(rectifier, side, kUnmatched, execution, map.unmatched);
}

}  // namespace vantage
