#include "engine/synthesis/photograph_grid.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "engine/error.h"
#include "engine/rectification/rectifier.h"

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

PhotographGrid::PhotographGrid(const Rectifier& rectifier, Execution& execution)
    : rectifier_(rectifier),
      execution_(execution),
      nearest_{find_nearest_pixels(Side::kLeft), find_nearest_pixels(Side::kRight)},
      whole_{WholePhotograph(rectifier, Side::kLeft, execution),
             WholePhotograph(rectifier, Side::kRight, execution)} {}

std::size_t PhotographGrid::held_bytes(int width, int height) {
  return 2 * sizeof(kernels::PixelPlace) * static_cast<std::size_t>(width) *
         static_cast<std::size_t>(height);
}

std::vector<kernels::PixelPlace> PhotographGrid::find_nearest_pixels(Side side) const {
  const int width = rectifier_.pair().width_px;
  const int height = rectifier_.pair().height_px;
  std::vector<kernels::PixelPlace> places(static_cast<std::size_t>(width) *
                                          static_cast<std::size_t>(height));
  const auto nearest = [](double position, int size) {
    return static_cast<int>(std::clamp(std::floor(position + 0.5), 0.0, size - 1.0));
  };
  execution_.for_each_band(height, [&](int first_row, int end_row) {
    RectifiedPositions positions(rectifier_, side);
    for (int y = first_row; y < end_row; ++y) {
      kernels::PixelPlace* row =
          places.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
      for (int x = 0; x < width; ++x) {
        const Eigen::Vector2d at = positions.position(x, y);
        row[x] = at.hasNaN()
                     ? kernels::kNoPlace
                     : kernels::pixel_place(nearest(at.x(), width), nearest(at.y(), height));
      }
    }
  });
  return places;
}

void PhotographGrid::bring(Side side, ImageView<const float> map, Image<float>& result) const {
  const int width = rectifier_.pair().width_px;
  const int height = rectifier_.pair().height_px;
  if (map.width() != width || map.height() != height) {
    throw Error(fmt::format("the disparity map is {}x{}, expected {}x{} as the rectified image",
                            map.width(), map.height(), width, height));
  }
  result.resize(width, height);
  const std::vector<kernels::PixelPlace>& places = nearest_[index_of(side)];
  execution_.for_each_row(height, [&](int y) {
    kernels::look_up_row(
        map.data(), static_cast<std::ptrdiff_t>(map.stride()),
        places.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width), width,
        result.row(y));
  });
}

void PhotographGrid::bring(const DisparityMaps& maps, std::array<Image<float>, 2>& results) const {
  bring(Side::kLeft, maps.left.disparity_px.view(), results[0]);
  bring(Side::kRight, maps.right.disparity_px.view(), results[1]);
}

UnrectifiedPair PhotographGrid::pair_of(const Photograph& left, const Photograph& right,
                                        const std::array<Image<float>, 2>& photograph_maps) const {
  return {.left = left,
          .right = right,
          .left_geometry = {.positions = rectifier_.source_positions(Side::kLeft),
                            .disparity_px = photograph_maps[0].view(),
                            .whole = &whole_[0]},
          .right_geometry = {.positions = rectifier_.source_positions(Side::kRight),
                             .disparity_px = photograph_maps[1].view(),
                             .whole = &whole_[1]}};
}

}  // namespace vantage
