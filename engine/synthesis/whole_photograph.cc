#include "engine/synthesis/whole_photograph.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace vantage {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

/// First and last pixel along one axis.
struct Extent {
  double first;
  double last;

  void include(double position) {
    first = std::min(first, position);
    last = std::max(last, position);
  }
  /// Whole pixels, at most `size` beyond 0 … size − 1 on either side.
  [[nodiscard]] Extent limited(int size) const {
    return {std::max(std::floor(first), -1.0 * size), std::min(std::ceil(last), 2.0 * size - 1)};
  }
  [[nodiscard]] int count() const { return static_cast<int>(last - first) + 1; }
};

}  // namespace

WholePhotograph::WholePhotograph(const Rectifier& rectifier, Side side, Execution& execution)
    : rectifier_(rectifier), side_(side), execution_(execution) {}

const WholePhotograph::Window& WholePhotograph::window() const {
  std::call_once(is_made_, [this] { make_window(); });
  return window_;
}

void WholePhotograph::make_window() const {
  const int width = rectifier_.pair().width_px;
  const int height = rectifier_.pair().height_px;
  Extent columns{0, width - 1.0};
  Extent rows{0, height - 1.0};
  const auto include = [&](double x, double y) {
    if (const std::optional<Eigen::Vector2d> at = rectifier_.rectified_position(side_, {x, y})) {
      columns.include(at->x());
      rows.include(at->y());
    }
  };
  for (int x = 0; x < width; ++x) {
    include(x, 0);
    include(x, height - 1);
  }
  for (int y = 0; y < height; ++y) {
    include(0, y);
    include(width - 1, y);
  }
  columns = columns.limited(width);
  rows = rows.limited(height);
  const int window_width = columns.count();
  const int window_height = rows.count();

  x_px_.resize(window_width, window_height);
  y_px_.resize(window_width, window_height);
  disparity_px_.resize(window_width, window_height);
  const auto is_seen_at = [&](double x, double y) {
    const std::optional<Eigen::Vector2d> at = rectifier_.source_position(side_, {x, y});
    return at && at->x() >= -0.5 && at->x() <= width - 0.5 && at->y() >= -0.5 &&
           at->y() <= height - 0.5;
  };
  execution_.for_each_band(window_height, [&](int first_row, int end_row) {
    std::vector<char> upper(static_cast<std::size_t>(window_width + 1));
    std::vector<char> lower(upper.size());
    // Whether the photograph covers the corners above the pixels of row y.
    const auto find_corners = [&](int y, std::vector<char>& seen) {
      for (std::size_t x = 0; x < seen.size(); ++x) {
        seen[x] =
            is_seen_at(columns.first + static_cast<double>(x) - 0.5, rows.first + y - 0.5) ? 1 : 0;
      }
    };
    find_corners(first_row, upper);
    for (int y = first_row; y < end_row; ++y) {
      find_corners(y + 1, lower);
      for (int x = 0; x < window_width; ++x) {
        const std::optional<Eigen::Vector2d> at =
            rectifier_.source_position(side_, {columns.first + x, rows.first + y});
        const auto corner = static_cast<std::size_t>(x);
        const bool is_whole = at && upper[corner] != 0 && upper[corner + 1] != 0 &&
                              lower[corner] != 0 && lower[corner + 1] != 0;
        x_px_.at(x, y) = at ? static_cast<float>(at->x()) : kUnseen;
        y_px_.at(x, y) = at ? static_cast<float>(at->y()) : kUnseen;
        disparity_px_.at(x, y) = is_whole ? 0 : kUnseen;
      }
      std::swap(upper, lower);
    }
  });
  zeros_.resize(width, 1);
  zeros_.fill(0);
  window_ = {.first_px = {columns.first, rows.first},
             .positions = {x_px_.view(), y_px_.view()},
             .disparity_px = disparity_px_.view(),
             .photograph_disparity_px = {zeros_.row(0), width, height, 1, 0}};
}

}  // namespace vantage
