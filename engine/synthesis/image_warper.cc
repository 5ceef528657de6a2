#include "engine/synthesis/image_warper.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "engine/error.h"
#include "engine/synthesis/surface_map.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "kernels/photograph_position/photograph_position.h"
#include "kernels/surface_coverage/surface_coverage.h"
#include "kernels/surface_fetch/surface_fetch.h"
#include "kernels/view_projection/view_projection.h"

namespace vantage {
namespace {

constexpr int kLargestSide = 65500;

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

kernels::ViewProjection projection_of(const ViewWarp& warp, double infinity_disparity_px) {
  kernels::ViewProjection projection;
  RowMajor::Map(projection.homography) = warp.homography;
  Eigen::Vector3d::Map(projection.parallax) = warp.parallax;
  projection.infinity_disparity_px = infinity_disparity_px;
  projection.is_translation = warp.is_translation();
  return projection;
}

// λ (u, v, 1) = H∞ (x, y, 1) + λ q m, where H∞ is the homography of the points at infinity.
kernels::SourceProjection way_back(const ViewWarp& warp, double infinity_disparity_px) {
  kernels::SourceProjection back;
  back.infinity_disparity_px = infinity_disparity_px;
  back.is_translation = warp.is_translation();
  if (back.is_translation) {
    Eigen::Vector3d::Map(back.parallax) = warp.parallax;
    return back;
  }
  Eigen::Matrix3d far = warp.homography;
  far.col(2) += infinity_disparity_px * warp.parallax;
  const Eigen::FullPivLU<Eigen::Matrix3d> factors(far);
  if (!far.allFinite() || !factors.isInvertible() || !warp.parallax.allFinite()) {
    throw Error("new view has a homography that cannot be inverted, expected a camera's");
  }
  const Eigen::Matrix3d inverse = factors.inverse();
  RowMajor::Map(back.homography) = inverse;
  Eigen::Vector3d::Map(back.parallax) = inverse * warp.parallax;
  return back;
}

const ViewFrame& checked(const ViewFrame& frame) {
  if (frame.width_px < 1 || frame.height_px < 1 || frame.width_px > kLargestSide ||
      frame.height_px > kLargestSide) {
    throw Error(fmt::format("new view is {}×{}, expected 1..{} pixels in width and height",
                            frame.width_px, frame.height_px, kLargestSide));
  }
  return frame;
}

}  // namespace

template <typename T>
void SurfaceColours<T>::fetch(const kernels::SourcePositions& positions, int count,
                              float* colours) const {
  const ImageView<const float>& map = photograph.empty() ? disparity_px : photograph.disparity_px;
  if (!photograph.empty()) {
    kernels::photograph_positions_row(
        {.x_px = photograph.positions.x_px.data(),
         .y_px = photograph.positions.y_px.data(),
         .stride = static_cast<std::ptrdiff_t>(photograph.positions.x_px.stride()),
         .width = disparity_px.width(),
         .height = disparity_px.height(),
         .photograph_width = pixels.width(),
         .photograph_height = pixels.height()},
        positions, count);
  }
  kernels::fetch_surface_row(
      kernels::SurfaceFetchRow<T>{.pixels = pixels.data(),
                                  .stride = static_cast<std::ptrdiff_t>(pixels.stride()),
                                  .map_px = map.data(),
                                  .map_stride = static_cast<std::ptrdiff_t>(map.stride()),
                                  .width = pixels.width(),
                                  .height = pixels.height(),
                                  .channels = pixels.channels(),
                                  .column = positions.column,
                                  .line = positions.line,
                                  .fraction_x = positions.fraction_x,
                                  .fraction_y = positions.fraction_y,
                                  .disparity_px = positions.disparity_px,
                                  .count = count,
                                  .gradient_limit_px = gradient_limit_px},
      colours);
}

template struct SurfaceColours<std::uint8_t>;
template struct SurfaceColours<std::uint16_t>;
template struct SurfaceColours<float>;

template <typename T>
std::size_t ImageWarper<T>::held_bytes(int view_width, int view_height) {
  return sizeof(float) * row_floats(view_width, 1) * static_cast<std::size_t>(view_height);
}

template <typename T>
ImageWarper<T>::ImageWarper(ImageView<const T> image, ImageView<const float> disparity_px,
                            const ViewWarp& warp, const ViewFrame& frame,
                            const SynthesisOptions& options, Execution& execution,
                            const PhotographGeometry& photograph)
    : colours_{.pixels = image,
               .disparity_px = disparity_px,
               .photograph = photograph,
               .gradient_limit_px = static_cast<float>(options.disparity_gradient_limit_px)},
      takes_whole_pixels_(options.warp == WarpColour::kForward),
      back_(way_back(warp, checked(frame).infinity_disparity_px)),
      nearness_memory_(execution.scratch().lease(held_bytes(frame.width_px, frame.height_px))),
      nearness_(reinterpret_cast<float*>(nearness_memory_.data()), frame.width_px, frame.height_px,
                1, row_floats(frame.width_px, 1)) {
  map_surfaces(disparity_px, projection_of(warp, frame.infinity_disparity_px),
               colours_.gradient_limit_px, nearness_, execution);
}

template <typename T>
std::size_t ImageWarper<T>::scratch_floats() const {
  return position_floats(width());
}

// Moves the nearest pixel: for samples outside gaps, the one that was mapped there.
template <typename T>
void ImageWarper<T>::move_to_whole_pixels(const kernels::SourcePositions& positions) const {
  const auto move = [&](std::int32_t* whole, float* fraction, int size) {
    for (int i = 0; i < width(); ++i) {
      const int nearest = whole[i] + (fraction[i] >= 0.5F ? 1 : 0);
      whole[i] = std::clamp(nearest, 0, size - 1);
      fraction[i] = 0;
    }
  };
  move(positions.column, positions.fraction_x, colours_.disparity_px.width());
  move(positions.line, positions.fraction_y, colours_.disparity_px.height());
}

template <typename T>
void ImageWarper<T>::warp(int y, std::span<float> scratch, float* colours, float* nearness) const {
  const kernels::SourcePositions positions = positions_in(scratch, width(), nearness);
  kernels::source_positions_row(back_,
                                {.nearness = nearness_.row(y),
                                 .count = width(),
                                 .line = y,
                                 .source_width = colours_.disparity_px.width(),
                                 .source_height = colours_.disparity_px.height()},
                                positions);
  if (takes_whole_pixels_) {
    move_to_whole_pixels(positions);
  }
  colours_.fetch(positions, width(), colours);
}

template <typename T>
double ImageWarper<T>::coverage(const SurfaceEdge& edge) const {
  const float own = nearness_.row(edge.surface_y)[edge.surface_x];
  if (!(std::abs(own - edge.nearness) <= colours_.gradient_limit_px)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const ImageView<const float>& map_px = colours_.disparity_px;
  return kernels::surface_coverage({.way_back = back_,
                                    .disparity_px = map_px.data(),
                                    .stride = static_cast<std::ptrdiff_t>(map_px.stride()),
                                    .width = map_px.width(),
                                    .height = map_px.height(),
                                    .gradient_limit_px = colours_.gradient_limit_px},
                                   edge.x, edge.y, own, edge.background_nearness);
}

template class ImageWarper<std::uint8_t>;
template class ImageWarper<std::uint16_t>;
template class ImageWarper<float>;

}  // namespace vantage
