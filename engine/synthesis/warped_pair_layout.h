#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "kernels/intensity_sums/intensity_sums.h"
#include "kernels/pixel_row/pixel_row.h"
#include "kernels/source_position/source_position.h"

namespace vantage {

/// Floats of a row padded to whole cache lines.
[[nodiscard]] constexpr std::size_t row_floats(int columns, int lanes) {
  constexpr std::size_t kFloatsPerLine = 16;
  const std::size_t floats = static_cast<std::size_t>(columns) * static_cast<std::size_t>(lanes);
  return (floats + kFloatsPerLine - 1) / kFloatsPerLine * kFloatsPerLine;
}

/// Floats of scratch memory that positions_in() takes for a row of `width` pixels.
[[nodiscard]] constexpr std::size_t position_floats(int width) { return 5 * row_floats(width, 1); }
/// Rows for positions in `scratch`; `nearness`: the row for theirs.
[[nodiscard]] inline kernels::SourcePositions positions_in(std::span<float> scratch, int width,
                                                           float* nearness) {
  const auto part = [&](std::size_t k) { return scratch.data() + k * row_floats(width, 1); };
  return {.column = reinterpret_cast<std::int32_t*>(part(0)),
          .line = reinterpret_cast<std::int32_t*>(part(1)),
          .fraction_x = part(2),
          .fraction_y = part(3),
          .disparity_px = part(4),
          .nearness = nearness};
}

/// Offsets of the parts of a pair of warped scanlines in one block of memory.
struct WarpedPairLayout {
  int width = 0;
  int lanes = 0;
  std::size_t left_colours = 0;
  std::size_t right_colours;
  std::size_t left_nearness;
  std::size_t right_nearness;
  std::size_t floats;  ///< total

  WarpedPairLayout(int width_px, int channels)
      : width(width_px),
        lanes(kernels::pixel_lanes(channels)),
        right_colours(row_floats(width, lanes)),
        left_nearness(2 * right_colours),
        right_nearness(left_nearness + row_floats(width, 1)),
        floats(right_nearness + row_floats(width, 1)) {}

  [[nodiscard]] kernels::WarpedPairRow row_in(const float* memory, double gradient_limit_px) const {
    return {.left_colours = memory + left_colours,
            .right_colours = memory + right_colours,
            .left_disparity_px = memory + left_nearness,
            .right_disparity_px = memory + right_nearness,
            .width = width,
            .lanes = lanes,
            .gradient_limit_px = static_cast<float>(gradient_limit_px)};
  }
};

}  // namespace vantage
