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
/// Thread rule: one thread. Does not own any memory it is given, which must outlive it. T is
/// uint8_t, uint16_t or float.
template <typename T>
class RowPairWarper {
 public:
  /// What `scratch` must have. It holds no state between rows.
  static std::size_t scratch_floats(int width, int channels);
  /// What a pair of warped scanlines takes.
  static std::size_t pair_floats(int width, int channels);

  /// `scratch`: scratch_floats(width, channels) values.
  RowPairWarper(const StereoSource<T>& source, const SynthesisOptions& options, double view_x,
                std::span<float> scratch);

  /// Both scanlines y at the new view, in `memory` of pair_floats(width, channels) values.
  kernels::WarpedPairRow warp(int y, float* memory);

  /// What warp() returned for `memory`, from a warper of the same source and options.
  static kernels::WarpedPairRow warped_in(const StereoSource<T>& source,
                                          const SynthesisOptions& options, const float* memory);

 private:
  void warp_one(const T* pixels, const float* disparity_px, double camera_offset, float* colours,
                float* warped_disparity_px);

  const StereoSource<T>& source_;
  const SynthesisOptions& options_;
  double view_x_;
  int width_;
  int lanes_;
  float* source_pixels_;     // of x = 0; margins on both sides
  float* source_disparity_;  // likewise
  float* source_column_;
};

}  // namespace vantage
