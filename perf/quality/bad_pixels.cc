#include "perf/quality/bad_pixels.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/order_statistics.h"

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

/// Whether KITTI counts an error as an outlier; true for NaN.
bool is_outlier_of_kitti(double error_px, double truth_px) {
  return !(error_px <= 3 || error_px <= 0.05 * std::abs(truth_px));
}

}  // namespace

BadPixels bad_pixels(const MatchedMap& map, const LoadedScene& scene) {
  Counts visible;
  Counts all;
  Counts hidden;
  Counts visible_unmatched;
  Counts near;
  std::int64_t outliers = 0;
  std::vector<double> signed_errors_px;
  for (int y = 0; y < scene.truth.height(); ++y) {
    for (int x = 0; x < scene.truth.width(); ++x) {
      const double truth_px = scene.truth.at(x, y);
      if (!std::isfinite(truth_px)) {
        continue;
      }
      const double signed_error_px = map.disparity_px.at(x, y) - truth_px;
      const double error_px = std::abs(signed_error_px);
      const bool is_visible = scene.visible.at(x, y) != 0;
      all.add(error_px);
      (is_visible ? visible : hidden).add(error_px);
      outliers += is_outlier_of_kitti(error_px, truth_px) ? 1 : 0;
      if (is_visible && map.unmatched.at(x, y) != 0) {
        visible_unmatched.add(error_px);
      }
      if (scene.near_discontinuity.at(x, y) != 0) {
        near.add(error_px);
      }
      if (is_visible && !std::isnan(error_px)) {
        signed_errors_px.push_back(signed_error_px);
      }
    }
  }
  BadPixels result{.visible = visible.percent(),
                   .all = all.percent(),
                   .hidden = hidden.percent(),
                   .visible_unmatched = visible_unmatched.percent(),
                   .near_discontinuity = near.percent()};
  result.d1 = 100.0 * static_cast<double>(outliers) / static_cast<double>(all.pixels);
  if (!signed_errors_px.empty()) {
    result.median_error_px = upper_median(signed_errors_px);
  }
  return result;
}

}  // namespace vantage::perf
