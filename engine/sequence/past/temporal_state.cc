#include "engine/sequence/past/temporal_state.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace vantage {
namespace {

/// With a smaller share of still pixels there was a cut, and they are alike by chance.
constexpr std::int64_t kMinStillShare = 50;  // one in this many

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

bool same_size(const Photograph& a, const Image<std::uint8_t>& b) {
  return a.width() == b.width() && a.height() == b.height();
}

}  // namespace

TemporalState::TemporalState(const TemporalOptions& options)
    : options_(options), still_pixels_(options.threshold) {
  options_.validate();
}

void TemporalState::restart() {
  for (Side* side : {&left_, &right_}) {
    side->matched_px.resize(0, 0);
  }
}

DisparityPrior TemporalState::priors_for(const Photograph& left, const Photograph& right,
                                         Execution& execution) {
  if (options_.weight == 0) {
    return {};
  }
  return {.left_px = prior_for(left, left_, execution),
          .right_px = prior_for(right, right_, execution),
          .weight = options_.weight};
}

ImageView<const float> TemporalState::prior_for(const Photograph& image, Side& side,
                                                Execution& execution) {
  luma_intensity(image, execution, side.next_intensity);
  side.intensity_is_next = true;
  if (side.matched_px.empty() || !same_size(image, side.intensities)) {
    return {};
  }
  const std::int64_t still_pixels =
      still_pixels_.find(side.intensities, side.next_intensity, execution, side.still);
  const int width = image.width();
  const int height = image.height();
  if (still_pixels * kMinStillShare < static_cast<std::int64_t>(width) * height) {
    return {};
  }
  side.prior_px.resize(width, height);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      const float* matched = side.matched_px.row(y);
      std::transform(matched, matched + width, side.still.row(y), side.prior_px.row(y),
                     [](float d, std::uint8_t is_still) { return is_still != 0 ? d : kUnknown; });
    }
  });
  return side.prior_px.view();
}

void TemporalState::remember(const Photograph& left, const Photograph& right,
                             const DisparityMaps& maps, Execution& execution) {
  if (options_.weight == 0) {
    return;
  }
  remember_side(left, maps.left.disparity_px, maps.left.unmatched, left_, execution);
  remember_side(right, maps.right.disparity_px, maps.right.unmatched, right_, execution);
}

void TemporalState::remember_side(const Photograph& image, const DisparityMap& map,
                                  const Mask& unmatched, Side& side, Execution& execution) {
  if (!std::exchange(side.intensity_is_next, false)) {
    luma_intensity(image, execution, side.next_intensity);
  }
  std::swap(side.intensities, side.next_intensity);
  side.matched_px.resize(map.width(), map.height());
  execution.for_each_band(map.height(), [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      const float* disparity = map.row(y);
      std::transform(disparity, disparity + map.width(), unmatched.row(y), side.matched_px.row(y),
                     [](float d, std::uint8_t filled) { return filled != 0 ? kUnknown : d; });
    }
  });
}

}  // namespace vantage
