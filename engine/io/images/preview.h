#pragma once

#include <cstdint>

#include "engine/image/image.h"

namespace vantage {

/// The disparity range of a preview's colours, min_px < max_px.
struct PreviewRange {
  float min_px = 0;
  float max_px = 1;

  friend bool operator==(PreviewRange, PreviewRange) = default;
};

/// A range that shows most of the map well in spite of outliers: the 1st and the 99th percentile of
/// its finite values, widened to half a pixel on both sides if they coincide. {0, 1} for a map
/// without finite values.
PreviewRange choose_preview_range(ImageView<const float> disparity);

/// Renders a disparity map, one channel, in colours: 8-bit RGB of the same size in the Turbo colour
/// map, far = blue at min_px and below, near = red at max_px and above, unknown (NaN, ±inf) black.
/// Throws UsageError unless min_px < max_px, both finite.
Image<std::uint8_t> colour_preview(ImageView<const float> disparity, float min_px, float max_px);

}  // namespace vantage
