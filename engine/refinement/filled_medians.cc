#include "engine/refinement/filled_medians.h"

#include <algorithm>
#include <variant>

#include "kernels/filled_median/filled_median.h"

namespace vantage {
namespace {

/// Row by row in grey levels, rounded.
template <typename T>
void to_grey_levels(const Image<T>& photograph, Execution& execution, Image<std::uint8_t>& levels) {
  const int width = photograph.width();
  const int channels = photograph.channels();
  levels.resize(width, photograph.height(), channels);
  execution.for_each_band(photograph.height(), [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      const T* pixels = photograph.row(y);
      std::transform(pixels, pixels + width * channels, levels.row(y), [](T value) {
        const float level = static_cast<float>(value) * kGreyLevelsPerUnit<T>;
        return static_cast<std::uint8_t>(std::clamp(level, 0.0F, 255.0F) + 0.5F);
      });
    }
  });
}

const Image<std::uint8_t>& grey_levels(const Photograph& photograph, Execution& execution,
                                       Image<std::uint8_t>& memory) {
  if (const auto* levels = std::get_if<Image<std::uint8_t>>(&photograph.pixels)) {
    return *levels;
  }
  if (const auto* values = std::get_if<Image<std::uint16_t>>(&photograph.pixels)) {
    to_grey_levels(*values, execution, memory);
  } else {
    to_grey_levels(std::get<Image<float>>(photograph.pixels), execution, memory);
  }
  return memory;
}

}  // namespace

void take_filled_medians(const Mask& unmatched, const Photograph& photograph, Execution& execution,
                         FilledMediansWork& work, DisparityMap& map_px) {
  const int width = map_px.width();
  const int height = map_px.height();
  const Image<std::uint8_t>& pixels = grey_levels(photograph, execution, work.pixels);
  work.before.resize(width, height);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      std::copy_n(map_px.row(y), width, work.before.row(y));
    }
  });
  execution.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      kernels::take_filled_medians_row(
          {.disparity_px = work.before.row(y),
           .disparity_pitch = static_cast<std::ptrdiff_t>(work.before.view().stride()),
           .pixels = pixels.row(y),
           .pixel_pitch = static_cast<std::ptrdiff_t>(pixels.view().stride()),
           .channels = pixels.channels(),
           .unmatched = unmatched.row(y),
           .width = width,
           .rows_above = y,
           .rows_below = height - 1 - y},
          map_px.row(y));
    }
  });
}

}  // namespace vantage
