#include "engine/synthesis/pair_warpers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "engine/synthesis/surface_map.h"
#include "engine/synthesis/warped_pair_layout.h"
#include "engine/view_geometry/new_view.h"
#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/forward_warp/forward_warp.h"
#include "kernels/pixel_row/pixel_row.h"
#include "kernels/source_position/source_position.h"
#include "kernels/surface_coverage/surface_coverage.h"

namespace vantage {
namespace {

ViewFrame frame_of(const NewView& view) {
  return {.width_px = view.width_px,
          .height_px = view.height_px,
          .infinity_disparity_px = view.infinity_disparity_px};
}

// Options for an image whose camera is `distance` baselines away. At its own position nothing
// moves: there is no parallax to tear surfaces, and the whole image is one surface.
SynthesisOptions options_at(double distance, SynthesisOptions options) {
  if (distance < kSamePlace) {
    options.disparity_gradient_limit_px = std::numeric_limits<double>::infinity();
  }
  return options;
}

}  // namespace

template <typename T>
struct RowPairWarper<T>::SourceRows {
  float* planes;          // of x = 0; margins on both sides
  std::ptrdiff_t stride;  // floats between planes
  float* disparity_px;    // also with margins
  float* column;
};

template <typename T>
RowPairWarper<T>::RowPairWarper(const StereoSource<T>& source, const SynthesisOptions& options,
                                double view_x)
    : source_(source), options_(options), view_x_(view_x) {}

template <typename T>
double RowPairWarper<T>::alpha() const {
  return share_of_left(std::abs(view_x_), std::abs(view_x_ - 1));
}

template <typename T>
std::size_t RowPairWarper<T>::scratch_floats() const {
  if (!source_.left_photograph.empty()) {
    return position_floats(width()) + row_floats(width(), 1);
  }
  const int padded = width() + 2 * kernels::kRowMarginPx;
  return row_floats(padded, 1) * static_cast<std::size_t>(source_.left.channels() + 1) +
         row_floats(width(), 1);
}

template <typename T>
void RowPairWarper<T>::warp_one(const T* pixels, const float* disparity_px, double camera_offset,
                                const SourceRows& rows, float* colours,
                                float* warped_disparity_px) const {
  const auto limit = static_cast<float>(options_.disparity_gradient_limit_px);
  const bool forward = options_.warp == WarpColour::kForward;
  const int channels = source_.left.channels();
  kernels::load_pixel_planes(pixels, width(), channels, rows.stride, rows.planes);
  std::copy_n(disparity_px, width(), rows.disparity_px);
  kernels::forward_warp_row({.disparity_px = rows.disparity_px,
                             .width = width(),
                             .camera_offset = camera_offset,
                             .gradient_limit_px = limit},
                            warped_disparity_px, forward ? rows.column : nullptr);
  if (forward) {
    kernels::fetch_forward_row({.pixels = rows.planes,
                                .stride = rows.stride,
                                .source_column = rows.column,
                                .width = width(),
                                .channels = channels},
                               colours);
  } else {
    kernels::fetch_bicubic_row({.pixels = rows.planes,
                                .stride = rows.stride,
                                .source_disparity_px = rows.disparity_px,
                                .warped_disparity_px = warped_disparity_px,
                                .width = width(),
                                .channels = channels,
                                .camera_offset = camera_offset,
                                .gradient_limit_px = limit,
                                .largest_value = kernels::kLargestValue<T>,
                                .is_in_range = std::is_integral_v<T>},
                               colours);
  }
}

// The warp moves whole rows of the rectified image, so positions there are exact columns of row y.
template <typename T>
void RowPairWarper<T>::warp_from_photograph(const SurfaceColours<T>& from, int y,
                                            double camera_offset, std::span<float> scratch,
                                            float* colours, float* warped_disparity_px) const {
  float* const nearness = scratch.data() + position_floats(width());
  const kernels::SourcePositions positions = positions_in(scratch, width(), nearness);
  kernels::forward_warp_row({.disparity_px = from.disparity_px.row(y),
                             .width = width(),
                             .camera_offset = camera_offset,
                             .gradient_limit_px = from.gradient_limit_px},
                            warped_disparity_px, nullptr);
  kernels::SourceProjection back;
  back.parallax[0] = -camera_offset;
  kernels::source_positions_row(back,
                                {.nearness = warped_disparity_px,
                                 .count = width(),
                                 .line = y,
                                 .source_width = width(),
                                 .source_height = height()},
                                positions);
  from.fetch(positions, width(), colours);
}

template <typename T>
void RowPairWarper<T>::warp(int y, std::span<float> scratch, float* memory) const {
  if (source_.left_photograph.empty()) {
    warp_rectified(y, scratch, memory);
    return;
  }
  const WarpedPairLayout at(width(), source_.left.channels());
  const auto limit = static_cast<float>(options_.disparity_gradient_limit_px);
  warp_from_photograph({source_.left, source_.left_disparity, source_.left_photograph, limit}, y,
                       view_x_, scratch, memory + at.left_colours, memory + at.left_nearness);
  warp_from_photograph({source_.right, source_.right_disparity, source_.right_photograph, limit}, y,
                       view_x_ - 1, scratch, memory + at.right_colours, memory + at.right_nearness);
}

template <typename T>
void RowPairWarper<T>::warp_rectified(int y, std::span<float> scratch, float* memory) const {
  constexpr int kMargin = kernels::kRowMarginPx;
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  float* next = scratch.data();
  SourceRows rows{};
  const std::size_t row = row_floats(width() + 2 * kMargin, 1);
  rows.planes = next + kMargin;
  rows.stride = static_cast<std::ptrdiff_t>(row);
  next += row * static_cast<std::size_t>(source_.left.channels());
  rows.disparity_px = next + kMargin;
  std::fill_n(rows.disparity_px - kMargin, kMargin, kUnknown);
  std::fill_n(rows.disparity_px + width(), kMargin, kUnknown);
  next += row;
  rows.column = next;

  const WarpedPairLayout at(width(), source_.left.channels());
  // The cameras are at 0 and 1 (3.5).
  warp_one(source_.left.row(y), source_.left_disparity.row(y), view_x_, rows,
           memory + at.left_colours, memory + at.left_nearness);
  warp_one(source_.right.row(y), source_.right_disparity.row(y), view_x_ - 1, rows,
           memory + at.right_colours, memory + at.right_nearness);
}

template class RowPairWarper<std::uint8_t>;
template class RowPairWarper<std::uint16_t>;
template class RowPairWarper<float>;

template <typename T>
std::size_t SurfaceWarper<T>::working_bytes(const NewView& view, int source_width,
                                            int source_height) {
  return 2 * ImageWarper<T>::held_bytes(view.width_px, view.height_px) +
         surface_map_bytes(source_width, source_height);
}

template <typename T>
SurfaceWarper<T>::SurfaceWarper(const StereoSource<T>& source, const SynthesisOptions& options,
                                const NewView& view, Execution& execution)
    : alpha_(view.alpha()),
      left_(source.left, source.left_disparity, view.from_left, frame_of(view),
            options_at(view.distance_from_left, options), execution, source.left_photograph),
      right_(source.right, source.right_disparity, view.from_right, frame_of(view),
             options_at(view.distance_from_right, options), execution, source.right_photograph) {}

template <typename T>
void SurfaceWarper<T>::warp(int y, std::span<float> scratch, float* memory) const {
  const WarpedPairLayout at(width(), left_.channels());
  left_.warp(y, scratch, memory + at.left_colours, memory + at.left_nearness);
  right_.warp(y, scratch, memory + at.right_colours, memory + at.right_nearness);
}

template <typename T>
double SurfaceWarper<T>::coverage(const SurfaceEdge& edge) const {
  return kernels::joint_coverage(alpha_, left_.coverage(edge), right_.coverage(edge));
}

template class SurfaceWarper<std::uint8_t>;
template class SurfaceWarper<std::uint16_t>;
template class SurfaceWarper<float>;

}  // namespace vantage
