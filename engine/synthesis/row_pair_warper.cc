#include "engine/synthesis/row_pair_warper.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>

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

/// Where the parts of a pair of warped scanlines lie in its memory.
struct PairOffsets {
  std::size_t left_colours = 0;
  std::size_t right_colours;
  std::size_t left_disparity;
  std::size_t right_disparity;
  std::size_t end;

  PairOffsets(int width, int lanes)
      : right_colours(row_floats(width, lanes)),
        left_disparity(2 * right_colours),
        right_disparity(left_disparity + row_floats(width, 1)),
        end(right_disparity + row_floats(width, 1)) {}
};

}  // namespace

template <typename T>
std::size_t RowPairWarper<T>::scratch_floats(int width, int channels) {
  const int padded = width + 2 * kernels::kRowMarginPx;
  return row_floats(padded, kernels::pixel_lanes(channels)) + row_floats(padded, 1) +
         row_floats(width, 1);
}

template <typename T>
std::size_t RowPairWarper<T>::pair_floats(int width, int channels) {
  return PairOffsets(width, kernels::pixel_lanes(channels)).end;
}

template <typename T>
RowPairWarper<T>::RowPairWarper(const StereoSource<T>& source, const SynthesisOptions& options,
                                double view_x, std::span<float> scratch)
    : source_(source),
      options_(options),
      view_x_(view_x),
      width_(source.left.width()),
      lanes_(kernels::pixel_lanes(source.left.channels())) {
  constexpr int kMargin = kernels::kRowMarginPx;
  float* next = scratch.data();
  source_pixels_ = next + kMargin * lanes_;
  next += row_floats(width_ + 2 * kMargin, lanes_);
  source_disparity_ = next + kMargin;
  next += row_floats(width_ + 2 * kMargin, 1);
  source_column_ = next;
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(source_disparity_ - kMargin, kMargin, kUnknown);
  std::fill_n(source_disparity_ + width_, kMargin, kUnknown);
}

template <typename T>
void RowPairWarper<T>::warp_one(const T* pixels, const float* disparity_px, double camera_offset,
                                float* colours, float* warped_disparity_px) {
  const auto limit = static_cast<float>(options_.disparity_gradient_limit_px);
  const bool forward = options_.warp == WarpColour::kForward;
  kernels::load_pixel_row(pixels, width_, source_.left.channels(), source_pixels_);
  std::copy_n(disparity_px, width_, source_disparity_);
  kernels::forward_warp_row({.disparity_px = source_disparity_,
                             .width = width_,
                             .camera_offset = camera_offset,
                             .gradient_limit_px = limit},
                            warped_disparity_px, forward ? source_column_ : nullptr);
  if (forward) {
    kernels::fetch_forward_row({.pixels = source_pixels_,
                                .source_column = source_column_,
                                .width = width_,
                                .lanes = lanes_},
                               colours);
  } else {
    kernels::fetch_bicubic_row({.pixels = source_pixels_,
                                .source_disparity_px = source_disparity_,
                                .warped_disparity_px = warped_disparity_px,
                                .width = width_,
                                .lanes = lanes_,
                                .camera_offset = camera_offset,
                                .gradient_limit_px = limit,
                                .largest_value = kernels::kLargestValue<T>,
                                .is_in_range = std::is_integral_v<T>},
                               colours);
  }
}

template <typename T>
kernels::WarpedPairRow RowPairWarper<T>::warp(int y, float* memory) {
  const PairOffsets at(width_, lanes_);
  // The cameras are at 0 and 1 (3.5).
  warp_one(source_.left.row(y), source_.left_disparity.row(y), view_x_, memory + at.left_colours,
           memory + at.left_disparity);
  warp_one(source_.right.row(y), source_.right_disparity.row(y), view_x_ - 1,
           memory + at.right_colours, memory + at.right_disparity);
  return warped_in(source_, options_, memory);
}

template <typename T>
kernels::WarpedPairRow RowPairWarper<T>::warped_in(const StereoSource<T>& source,
                                                   const SynthesisOptions& options,
                                                   const float* memory) {
  const int width = source.left.width();
  const int lanes = kernels::pixel_lanes(source.left.channels());
  const PairOffsets at(width, lanes);
  return {.left_colours = memory + at.left_colours,
          .right_colours = memory + at.right_colours,
          .left_disparity_px = memory + at.left_disparity,
          .right_disparity_px = memory + at.right_disparity,
          .width = width,
          .lanes = lanes,
          .gradient_limit_px = static_cast<float>(options.disparity_gradient_limit_px)};
}

template class RowPairWarper<std::uint8_t>;
template class RowPairWarper<std::uint16_t>;
template class RowPairWarper<float>;

}  // namespace vantage
