#pragma once

#include <cstddef>
#include <span>

#include "engine/image/image.h"
#include "engine/synthesis/synthesis_options.h"
#include "kernels/intensity_sums/intensity_sums.h"

namespace vantage {

/// A rectified pair of photographs of one depth and its disparity maps; all of equal size.
template <typename T>
struct StereoSource {
  ImageView<const T> left;
  ImageView<const T> right;
  ImageView<const float> left_disparity;
  ImageView<const float> right_disparity;
};

/// Brings both images of a pair to a new view on the baseline, a scanline at a time.
///
/// Thread rule: one thread. Does not own `memory`, which must outlive it. T is uint8_t, uint16_t or
/// float.
template <typename T>
class RowPairWarper {
 public:
  /// What `memory` must have. It holds no state between rows.
  static std::size_t scratch_floats(int width, int channels);

  /// `memory`: scratch_floats(width, channels) values.
  RowPairWarper(const StereoSource<T>& source, const SynthesisOptions& options, double view_x,
                std::span<float> memory);

  /// Both scanlines y at the new view. Valid until the next call.
  kernels::WarpedPairRow warp(int y);

  /// Room for one value per column that warp() does not touch.
  [[nodiscard]] float* spare_row() const { return spare_; }

 private:
  struct WarpedRow {
    float* colours = nullptr;
    float* disparity_px = nullptr;
  };

  void warp_one(const T* pixels, const float* disparity_px, double camera_offset,
                const WarpedRow& warped);

  const StereoSource<T>& source_;
  const SynthesisOptions& options_;
  double view_x_;
  int width_;
  int lanes_;
  float* source_pixels_;     // of x = 0; margins on both sides
  float* source_disparity_;  // likewise
  float* source_column_;
  WarpedRow left_;
  WarpedRow right_;
  float* spare_;
};

}  // namespace vantage
