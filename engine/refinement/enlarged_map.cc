#include "engine/refinement/enlarged_map.h"

#include <algorithm>
#include <cstdint>
#include <variant>

#include "engine/image/repeated_columns.h"
#include "kernels/map_enlargement/map_enlargement.h"

namespace vantage {
void enlarge_map(const MatchedMap& half, const Photograph& image, const Photograph& half_image,
                 Execution& execution, MatchedMap& map) {
  const auto& pixels = std::get<Image<std::uint8_t>>(image.pixels);
  const auto& half_pixels = std::get<Image<std::uint8_t>>(half_image.pixels);
  const int width = pixels.width();
  const int height = pixels.height();
  map.disparity_px.resize(width, height);
  map.unmatched.resize(width, height);
  map.disparity_y_px.resize(0, 0);
  const bool has_confidence = !half.confidence.empty();
  map.confidence.resize(has_confidence ? width : 0, has_confidence ? height : 0);
  execution.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      const int own = y / 2;
      const int beside =
          std::clamp(y % 2 == 0 ? own - 1 : own + 1, 0, half.disparity_px.height() - 1);
      kernels::enlarge_map_row({.own_px = half.disparity_px.row(own),
                                .beside_px = half.disparity_px.row(beside),
                                .own_intensities = half_pixels.row(own),
                                .beside_intensities = half_pixels.row(beside),
                                .intensities = pixels.row(y),
                                .width = width},
                               map.disparity_px.row(y));
      if (y % 2 == 1 && y > first_row) {
        std::copy_n(map.unmatched.row(y - 1), width, map.unmatched.row(y));
      } else {
        repeat_columns(half.unmatched.row(own), {0, width}, map.unmatched.row(y));
      }
      if (has_confidence) {
        repeat_columns(half.confidence.row(own), {0, width}, map.confidence.row(y));
      }
    }
  });
}

}  // namespace vantage
