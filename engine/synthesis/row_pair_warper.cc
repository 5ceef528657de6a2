#include "engine/synthesis/row_pair_warper.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/forward_warp/forward_warp.h"
#include "kernels/pixel_row/pixel_row.h"

namespace vantage {
namespace {

// Rows start on cache lines.
std::size_t row_floats(int columns, int lanes) {
  constexpr std::size_t kFloatsPerLine = 16;
  const std::size_t floats = static_cast<std::size_t>(columns) * static_cast<std::size_t>(lanes);
  return (floats + kFloatsPerLine - 1) / kFloatsPerLine * kFloatsPerLine;
}

}  // namespace

template <typename T>
std::size_t RowPairWarper<T>::scratch_floats(int width, int channels) {
  const int lanes = kernels::pixel_lanes(channels);
  const int padded = width + 2 * kernels::kRowMarginPx;
  return row_floats(padded, lanes) + row_floats(padded, 1) + 2 * row_floats(width, lanes) +
         4 * row_floats(width, 1);
}

template <typename T>
RowPairWarper<T>::RowPairWarper(const StereoSource<T>& source, const SynthesisOptions& options,
                                double view_x, std::span<float> memory)
    : source_(source),
      options_(options),
      view_x_(view_x),
      width_(source.left.width()),
      lanes_(kernels::pixel_lanes(source.left.channels())) {
  float* next = memory.data();
  const auto take = [&](int columns, int lanes) {
    float* row = next;
    next += row_floats(columns, lanes);
    return row;
  };
  constexpr int kMargin = kernels::kRowMarginPx;
  source_pixels_ = take(width_ + 2 * kMargin, lanes_) + kMargin * lanes_;
  source_disparity_ = take(width_ + 2 * kMargin, 1) + kMargin;
  source_column_ = take(width_, 1);
  left_ = {.colours = take(width_, lanes_), .disparity_px = take(width_, 1)};
  right_ = {.colours = take(width_, lanes_), .disparity_px = take(width_, 1)};
  spare_ = take(width_, 1);
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(source_disparity_ - kMargin, kMargin, kUnknown);
  std::fill_n(source_disparity_ + width_, kMargin, kUnknown);
}

template <typename T>
void RowPairWarper<T>::warp_one(const T* pixels, const float* disparity_px, double camera_offset,
                                const WarpedRow& warped) {
  const auto limit = static_cast<float>(options_.disparity_gradient_limit_px);
  const bool forward = options_.warp == WarpColour::kForward;
  kernels::load_pixel_row(pixels, width_, source_.left.channels(), source_pixels_);
  std::copy_n(disparity_px, width_, source_disparity_);
  kernels::forward_warp_row({.disparity_px = source_disparity_,
                             .width = width_,
                             .camera_offset = camera_offset,
                             .gradient_limit_px = limit},
                            warped.disparity_px, forward ? source_column_ : nullptr);
  if (forward) {
    kernels::fetch_forward_row({.pixels = source_pixels_,
                                .source_column = source_column_,
                                .width = width_,
                                .lanes = lanes_},
                               warped.colours);
  } else {
    kernels::fetch_bicubic_row({.pixels = source_pixels_,
                                .source_disparity_px = source_disparity_,
                                .warped_disparity_px = warped.disparity_px,
                                .width = width_,
                                .lanes = lanes_,
                                .camera_offset = camera_offset,
                                .gradient_limit_px = limit,
                                .largest_value = kernels::kLargestValue<T>},
                               warped.colours);
  }
}

template <typename T>
kernels::WarpedPairRow RowPairWarper<T>::warp(int y) {
  // The cameras are at 0 and 1 (3.5).
  warp_one(source_.left.row(y), source_.left_disparity.row(y), view_x_, left_);
  warp_one(source_.right.row(y), source_.right_disparity.row(y), view_x_ - 1, right_);
  return {.left_colours = left_.colours,
          .right_colours = right_.colours,
          .left_disparity_px = left_.disparity_px,
          .right_disparity_px = right_.disparity_px,
          .width = width_,
          .lanes = lanes_,
          .gradient_limit_px = static_cast<float>(options_.disparity_gradient_limit_px)};
}

template class RowPairWarper<std::uint8_t>;
template class RowPairWarper<std::uint16_t>;
template class RowPairWarper<float>;

}  // namespace vantage
