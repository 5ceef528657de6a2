#include "engine/synthesis/photograph_grid.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/error.h"
#include "engine/rectification/rectified_positions.h"

namespace vantage {
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
  execution_.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      kernels::look_up_row(
          map.data(), static_cast<std::ptrdiff_t>(map.stride()),
          places.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width), width,
          result.row(y));
    }
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
