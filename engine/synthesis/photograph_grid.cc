#include "engine/synthesis/photograph_grid.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr int kPatchPx = 8;
/// Deviation up to which a patch counts as bilinear; small against half a pixel, which changes the
/// nearest pixel.
constexpr double kLargestBend = 0.03;  // px

/// The rectified positions of a photograph's pixels. Lenses are smooth: positions are interpolated
/// between the corners of small patches, unless the lens bends even those.
class PatchRow {
 public:
  PatchRow(const Rectifier& rectifier, Side side)
      : rectifier_(rectifier),
        side_(side),
        patches_(static_cast<std::size_t>((rectifier.pair().width_px - 1) / kPatchPx + 1)) {}

  /// NaN where the lens model has no position.
  [[nodiscard]] Eigen::Vector2d position(int x, int y) {
    if (y / kPatchPx != row_) {
      row_ = y / kPatchPx;
      make_patches();
    }
    const Patch& patch = patches_[static_cast<std::size_t>(x / kPatchPx)];
    return patch.is_smooth ? patch.position(static_cast<double>(x % kPatchPx) / kPatchPx,
                                            static_cast<double>(y % kPatchPx) / kPatchPx)
                           : exact(x, y);
  }

 private:
  struct Patch {
    bool is_smooth;
    std::array<Eigen::Vector2d, 4> corners;  // upper left and right, lower left and right

    [[nodiscard]] Eigen::Vector2d position(double along, double down) const {
      return (1 - down) * ((1 - along) * corners[0] + along * corners[1]) +
             down * ((1 - along) * corners[2] + along * corners[3]);
    }
  };

  [[nodiscard]] Eigen::Vector2d exact(double x, double y) const {
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    return rectifier_.rectified_position(side_, {x, y})
        .value_or(Eigen::Vector2d::Constant(kNowhere));
  }

  void make_patches() {
    const double top = kPatchPx * row_;
    Eigen::Vector2d upper_right = exact(0, top);
    Eigen::Vector2d lower_right = exact(0, top + kPatchPx);
    double left = 0;
    for (Patch& patch : patches_) {
      patch.corners[0] = upper_right;
      patch.corners[2] = lower_right;
      upper_right = exact(left + kPatchPx, top);
      lower_right = exact(left + kPatchPx, top + kPatchPx);
      patch.corners[1] = upper_right;
      patch.corners[3] = lower_right;
      const Eigen::Vector2d centre = exact(left + kPatchPx / 2.0, top + kPatchPx / 2.0);
      patch.is_smooth = (patch.position(0.5, 0.5) - centre).norm() <= kLargestBend;  // false for
                                                                                     // NaN
      left += kPatchPx;
    }
  }

  const Rectifier& rectifier_;
  Side side_;
  std::vector<Patch> patches_;
  int row_ = -1;
};

}  // namespace

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
    PatchRow patches(rectifier_, side);
    for (int y = first_row; y < end_row; ++y) {
      kernels::PixelPlace* row =
          places.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
      for (int x = 0; x < width; ++x) {
        const Eigen::Vector2d at = patches.position(x, y);
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
