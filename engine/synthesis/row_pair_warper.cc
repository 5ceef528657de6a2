#include "engine/synthesis/row_pair_warper.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "engine/synthesis/warped_pair_layout.h"
#include "engine/view_geometry/new_view.h"
#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/forward_warp/forward_warp.h"
#include "kernels/pixel_row/pixel_row.h"
#include "kernels/source_position/source_position.h"

namespace vantage {
namespace {

/// Rows of SourcePositions.
constexpr std::size_t kPositionRows = 6;

}  // namespace

template <typename T>
struct RowPairWarper<T>::SourceRows {
  float* pixels;        // of x = 0; margins on both sides
  float* disparity_px;  // also with margins
  float* column;
};

template <typename T>
RowPairWarper<T>::RowPairWarper(const StereoSource<T>& source, const SynthesisOptions& options,
                                double view_x)
    : source_(source),
      options_(options),
      view_x_(view_x),
      lanes_(kernels::pixel_lanes(source.left.channels())) {}

template <typename T>
double RowPairWarper<T>::alpha() const {
  return share_of_left(std::abs(view_x_), std::abs(view_x_ - 1));
}

template <typename T>
std::size_t RowPairWarper<T>::scratch_floats() const {
  if (!source_.left_photograph.empty()) {
    return kPositionRows * row_floats(width(), 1);
  }
  const int padded = width() + 2 * kernels::kRowMarginPx;
  return row_floats(padded, lanes_) + row_floats(padded, 1) + row_floats(width(), 1);
}

template <typename T>
void RowPairWarper<T>::warp_one(const T* pixels, const float* disparity_px, double camera_offset,
                                const SourceRows& rows, float* colours,
                                float* warped_disparity_px) const {
  const auto limit = static_cast<float>(options_.disparity_gradient_limit_px);
  const bool forward = options_.warp == WarpColour::kForward;
  kernels::load_pixel_row(pixels, width(), source_.left.channels(), rows.pixels);
  std::copy_n(disparity_px, width(), rows.disparity_px);
  kernels::forward_warp_row({.disparity_px = rows.disparity_px,
                             .width = width(),
                             .camera_offset = camera_offset,
                             .gradient_limit_px = limit},
                            warped_disparity_px, forward ? rows.column : nullptr);
  if (forward) {
    kernels::fetch_forward_row(
        {.pixels = rows.pixels, .source_column = rows.column, .width = width(), .lanes = lanes_},
        colours);
  } else {
    kernels::fetch_bicubic_row({.pixels = rows.pixels,
                                .source_disparity_px = rows.disparity_px,
                                .warped_disparity_px = warped_disparity_px,
                                .width = width(),
                                .lanes = lanes_,
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
  const auto part = [&](std::size_t k) { return scratch.data() + k * row_floats(width(), 1); };
  const kernels::SourcePositions positions{.column = reinterpret_cast<std::int32_t*>(part(0)),
                                           .line = reinterpret_cast<std::int32_t*>(part(1)),
                                           .fraction_x = part(2),
                                           .fraction_y = part(3),
                                           .disparity_px = part(4),
                                           .nearness = part(5)};
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
  rows.pixels = next + kMargin * lanes_;
  next += row_floats(width() + 2 * kMargin, lanes_);
  rows.disparity_px = next + kMargin;
  std::fill_n(rows.disparity_px - kMargin, kMargin, kUnknown);
  std::fill_n(rows.disparity_px + width(), kMargin, kUnknown);
  next += row_floats(width() + 2 * kMargin, 1);
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

}  // namespace vantage
