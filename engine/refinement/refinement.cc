#include "engine/refinement/refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/cross_check/cross_check.h"
#include "kernels/fill_unmatched/fill_unmatched.h"

namespace vantage {
namespace {

// Neighbours whose disparities differ by at most this are one surface (EQUATIONS §6).
constexpr float kFillSurfaceStepPx = 1;

bool fill_row(const std::uint8_t* unmatched, Side side, Fill fill, int width, float* row_px) {
  const auto background =
      side == Side::kLeft ? kernels::BackgroundSide::kLeft : kernels::BackgroundSide::kRight;
  return fill == Fill::kLinear ? kernels::fill_unmatched_row_linearly(
                                     unmatched, background, kFillSurfaceStepPx, width, row_px)
                               : kernels::fill_unmatched_row(unmatched, background, width, row_px);
}

kernels::CrossCheckRow row_to_check(ImageView<const float> map_px, int y, Side side,
                                    double tolerance_px, float columns_per_px, Mask& unmatched) {
  return {.own_px = map_px.row(y),
          .direction = direction_of(side),
          .tolerance_px = tolerance_px,
          .width = map_px.width(),
          .unmatched = unmatched.row(y),
          .columns_per_px = columns_per_px};
}

/// Whether the partner of (x, y) lies inside `other` and has nearly the same displacement.
/// `direction` is −1 from the left map to the right one, +1 from right to left.
bool agrees(const DisplacementView& own, const DisplacementView& other, int direction,
            double tolerance_px, int x, int y) {
  const double own_x = own.x_px.at(x, y);
  const double own_y = own.y_px.at(x, y);
  const double partner_x = std::floor(x + direction * own_x + 0.5);
  const double partner_y = std::floor(y + direction * own_y + 0.5);
  if (!(partner_x >= 0 && partner_x < own.x_px.width() && partner_y >= 0 &&
        partner_y < own.x_px.height())) {  // true for NaN
    return false;
  }
  const int column = static_cast<int>(partner_x);
  const int row = static_cast<int>(partner_y);
  return std::abs(own_x - other.x_px.at(column, row)) < tolerance_px &&
         std::abs(own_y - other.y_px.at(column, row)) < tolerance_px;
}

/// Makes unmatched pixels unknown.
void erase_unmatched(const Mask& unmatched, Execution& execution, DisparityMap& map_px) {
  execution.for_each_row(map_px.height(), [&](int y) {
    for (int x = 0; x < map_px.width(); ++x) {
      if (unmatched.at(x, y) != 0) {
        map_px.at(x, y) = std::numeric_limits<float>::quiet_NaN();
      }
    }
  });
}

}  // namespace

void cross_check(ImageView<const float> map_px, ImageView<const float> other_px, Side side,
                 double tolerance_px, Execution& execution, Mask& unmatched, float columns_per_px) {
  unmatched.resize(map_px.width(), map_px.height());
  execution.for_each_row(map_px.height(), [&](int y) {
    kernels::cross_check_row(row_to_check(map_px, y, side, tolerance_px, columns_per_px, unmatched),
                             other_px.row(y));
  });
}

void cross_check(const DisplacementView& map, const DisplacementView& other, Side side,
                 double tolerance_px, Execution& execution, Mask& unmatched) {
  unmatched.resize(map.x_px.width(), map.x_px.height());
  execution.for_each_row(map.x_px.height(), [&](int y) {
    for (int x = 0; x < map.x_px.width(); ++x) {
      unmatched.at(x, y) = agrees(map, other, direction_of(side), tolerance_px, x, y) ? 0 : 255;
    }
  });
}

void mark_unknown(ImageView<const float> map_px, Execution& execution, Mask& unknown) {
  unknown.resize(map_px.width(), map_px.height());
  execution.for_each_row(map_px.height(), [&](int y) {
    const float* values = map_px.row(y);
    std::uint8_t* is_unknown = unknown.row(y);
    for (int x = 0; x < map_px.width(); ++x) {
      is_unknown[x] = std::isnan(values[x]) ? 255 : 0;
    }
  });
}

void mark_unsure(ImageView<const float> confidence, double threshold, Execution& execution,
                 Mask& unmatched) {
  execution.for_each_row(confidence.height(), [&](int y) {
    for (int x = 0; x < confidence.width(); ++x) {
      if (!(confidence.at(x, y) > threshold)) {  // true for NaN
        unmatched.at(x, y) = 255;
      }
    }
  });
}

void fill_unmatched(const Mask& unmatched, Side side, Fill fill, Execution& execution,
                    DisparityMap& map_px) {
  if (fill == Fill::kNone) {
    erase_unmatched(unmatched, execution, map_px);
    return;
  }
  const int height = map_px.height();
  std::vector<char> has_match(static_cast<std::size_t>(height));
  execution.for_each_row(height, [&](int y) {
    has_match[static_cast<std::size_t>(y)] =
        fill_row(unmatched.row(y), side, fill, map_px.width(), map_px.row(y));
  });

  int above = -1;  // last row with a match
  int below = 0;   // next one, or height
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
