#include "perf/quality/bad_pixels.h"

#include <cmath>
#include <cstdint>

namespace vantage::perf {
namespace {

struct Counts {
  std::array<std::int64_t, kBadAbovePx.size()> bad{};
  std::int64_t pixels = 0;

  /// A NaN error counts as bad.
  void add(double error_px) {
    ++pixels;
    for (std::size_t i = 0; i < kBadAbovePx.size(); ++i) {
      bad[i] += error_px <= kBadAbovePx[i] ? 0 : 1;
    }
  }
  [[nodiscard]] BadPercent percent() const {
    BadPercent result{};
    for (std::size_t i = 0; i < kBadAbovePx.size(); ++i) {
      result[i] = 100.0 * static_cast<double>(bad[i]) / static_cast<double>(pixels);
    }
    return result;
  }
};

}  // namespace

BadPixels bad_pixels(const DisparityMap& map, const LoadedScene& scene) {
  Counts visible;
  Counts all;
  Counts near;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const double truth = scene.truth.at(x, y);
      if (!std::isfinite(truth)) {
        continue;
      }
      const double error_px = std::abs(map.at(x, y) - truth);
      all.add(error_px);
      if (scene.visible.at(x, y) != 0) {
        visible.add(error_px);
      }
      if (scene.near_discontinuity.at(x, y) != 0) {
        near.add(error_px);
      }
    }
  }
  return {visible.percent(), all.percent(), near.percent()};
}

}  // namespace vantage::perf
