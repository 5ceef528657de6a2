#include "engine/refinement/refinement.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/cross_check/cross_check.h"
#include "kernels/fill_unmatched/fill_unmatched.h"

namespace vantage {

void cross_check(ImageView<const float> left_px, ImageView<const float> right_px,
                 double tolerance_px, Execution& execution, Mask& left_unmatched,
                 Mask& right_unmatched) {
  const int width = left_px.width();
  left_unmatched.resize(width, left_px.height());
  right_unmatched.resize(width, left_px.height());
  execution.for_each_band(left_px.height(), [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      kernels::cross_check_row(left_px.row(y), right_px.row(y), -1, tolerance_px, width,
                               left_unmatched.row(y));
      kernels::cross_check_row(right_px.row(y), left_px.row(y), +1, tolerance_px, width,
                               right_unmatched.row(y));
    }
  });
}

void mark_unknown(ImageView<const float> map_px, Execution& execution, Mask& unknown) {
  unknown.resize(map_px.width(), map_px.height());
  execution.for_each_band(map_px.height(), [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      const float* values = map_px.row(y);
      std::uint8_t* is_unknown = unknown.row(y);
      for (int x = 0; x < map_px.width(); ++x) {
        is_unknown[x] = std::isnan(values[x]) ? 255 : 0;
      }
    }
  });
}

void fill_unmatched(const Mask& unmatched, MapSide side, Execution& execution,
                    DisparityMap& map_px) {
  const int height = map_px.height();
  const auto background =
      side == MapSide::kLeft ? kernels::BackgroundSide::kLeft : kernels::BackgroundSide::kRight;
  std::vector<char> has_match(static_cast<std::size_t>(height));
  execution.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      has_match[static_cast<std::size_t>(y)] =
          kernels::fill_unmatched_row(unmatched.row(y), background, map_px.width(), map_px.row(y));
    }
  });

  int above = -1;  // the last row with a match
  int below = 0;   // the next one, or height
  for (int y = 0; y < height; ++y) {
    if (has_match[static_cast<std::size_t>(y)] != 0) {
      above = y;
      continue;
    }
    for (below = std::max(below, y); below < height; ++below) {
      if (has_match[static_cast<std::size_t>(below)] != 0) {
        break;
      }
    }
    const bool take_above = above >= 0 && (below == height || y - above <= below - y);
    if (take_above || below < height) {
      const float* source = map_px.row(take_above ? above : below);
      std::copy_n(source, map_px.width(), map_px.row(y));
    }
  }
}

}  // namespace vantage
