#pragma once

#include <array>

#include "engine/image/image.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Errors above which pixels are bad.
inline constexpr std::array kBadAbovePx = {0.5, 1.0, 2.0};

/// Percentages of pixels with an error above kBadAbovePx or without an estimate; NaN of no pixels.
using BadPercent = std::array<double, kBadAbovePx.size()>;

/// Of one map, or means over several.
struct BadPixels {
  BadPercent visible{};             ///< in both images
  BadPercent all{};                 ///< all that the truth knows
  BadPercent near_discontinuity{};  ///< LoadedScene::near_discontinuity
};

/// The left map of a scene against its truth.
BadPixels bad_pixels(const DisparityMap& map, const LoadedScene& scene);

}  // namespace vantage::perf
