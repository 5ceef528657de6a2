#pragma once

#include <array>
#include <limits>

#include "engine/image/disparity_maps.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Thresholds above which an error is bad.
inline constexpr std::array kBadAbovePx = {0.5, 1.0, 2.0};

/// Percentages of pixels with an error above kBadAbovePx or without an estimate; NaN if there are
/// no pixels.
using BadPercent = std::array<double, kBadAbovePx.size()>;

/// Results of one map, or means over several.
struct BadPixels {
  BadPercent visible{};             ///< pixels seen in both images
  BadPercent all{};                 ///< all pixels with known truth
  BadPercent hidden{};              ///< those of them that are not visible
  BadPercent visible_unmatched{};   ///< visible, but filled: they failed the cross-check
  BadPercent near_discontinuity{};  ///< LoadedScene::near_discontinuity
  /// D1 of KITTI: percentage of all pixels that are wrong by over 3 px and over 5 % of the truth.
  double d1 = std::numeric_limits<double>::quiet_NaN();
  /// Median of estimate − truth over the visible pixels: a truth with an offset, or in whole
  /// pixels, is no error of matching.
  double median_error_px = std::numeric_limits<double>::quiet_NaN();
};

/// Compares the left map of a scene with its truth.
BadPixels bad_pixels(const MatchedMap& map, const LoadedScene& scene);

}  // namespace vantage::perf
