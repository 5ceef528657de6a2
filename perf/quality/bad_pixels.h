#pragma once

#include <array>

#include "engine/image/image.h"
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
  BadPercent near_discontinuity{};  ///< LoadedScene::near_discontinuity
};

/// Compares the left map of a scene with its truth.
BadPixels bad_pixels(const DisparityMap& map, const LoadedScene& scene);

}  // namespace vantage::perf
