#include "apps/inputs/given_maps.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/error.h"

namespace vantage::apps {
namespace {

constexpr double kMinShare = 0.6;
constexpr double kClearlyLess = 0.75;
constexpr float kTolerance_px = 1;

struct Agreement {
  double share = 0;           ///< of the left map's pixels with a partner, those that agree
  double negative_share = 0;  ///< of them all, those with negative disparities
};

/// Compares left pixels with their partners at x − sign · d.
Agreement agreement_of(const DisparityMaps& maps, float sign) {
  long long partners = 0;
  long long agreeing = 0;
  long long negative = 0;
  for (int y = 0; y < maps.left.disparity_px.height(); ++y) {
    for (int x = 0; x < maps.left.disparity_px.width(); ++x) {
      const float d = maps.left.disparity_px.at(x, y);
      const float partner = std::round(static_cast<float>(x) - sign * d);
      if (!std::isfinite(d) || !(partner >= 0) ||
          !(partner < static_cast<float>(maps.right.disparity_px.width()))) {
        continue;
      }
      ++partners;
      negative += d < 0 ? 1 : 0;
      agreeing +=
          std::abs(maps.right.disparity_px.at(static_cast<int>(partner), y) - d) <= kTolerance_px
              ? 1
              : 0;
    }
  }
  const auto all = static_cast<double>(partners);
  return partners == 0
             ? Agreement()
             : Agreement{static_cast<double>(agreeing) / all, static_cast<double>(negative) / all};
}

}  // namespace

void require_agreeing_maps(const DisparityMaps& maps) {
  if (maps.left.disparity_px.width() != maps.right.disparity_px.width() ||
      maps.left.disparity_px.height() != maps.right.disparity_px.height()) {
    return;
  }
  const Agreement as_declared = agreement_of(maps, 1);
  const Agreement turned_round = agreement_of(maps, -1);
  if (turned_round.share >= kMinShare && as_declared.share < kClearlyLess * turned_round.share) {
    throw Error(fmt::format(
        "left and right disparity maps agree at {:.0f} % of the pixels, but at {:.0f} % with {}: "
        "expected x_left - x_right in both",
        100 * as_declared.share, 100 * turned_round.share,
        turned_round.negative_share > 0.5 ? "the other sign" : "the maps exchanged"));
  }
}

}  // namespace vantage::apps
