#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/synthesis/image_warper.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/synthesis/unrectified_pair.h"
#include "engine/view_geometry/new_view.h"
#include "kernels/view_blend/view_blend.h"

namespace vantage {

/// A rectified pair of photographs of one depth and its disparity maps, all of equal size; or the
/// unrectified photographs, if the geometries are not empty.
template <typename T>
struct StereoSource {
  ImageView<const T> left;
  ImageView<const T> right;
  ImageView<const float> left_disparity;
  ImageView<const float> right_disparity;
  PhotographGeometry left_photograph = {};
  PhotographGeometry right_photograph = {};
};

/// Warps both images of a pair to a new view on the baseline, one scanline at a time: disparities
/// along the rows of the rectified images, colours from them or from their photographs.
///
/// Thread rule: immutable. Does not own any memory it is given, which must outlive it. T is
/// uint8_t, uint16_t or float.
template <typename T>
class RowPairWarper {
 public:
  RowPairWarper(const StereoSource<T>& source, const SynthesisOptions& options, double view_x);

  /// Size of the new view: that of the images.
  [[nodiscard]] int width() const { return source_.left.width(); }
  [[nodiscard]] int height() const { return source_.left.height(); }
  /// Share of the left image (3.14) for YS = 0.
  [[nodiscard]] double alpha() const;
  /// Distance s of the view from the left and the right camera, signed, in baselines.
  [[nodiscard]] std::array<double, 2> camera_offsets() const { return {view_x_, view_x_ - 1}; }

  /// Scratch memory of one call of warp(), in floats; not kept between calls.
  [[nodiscard]] std::size_t scratch_floats() const;

  /// Warps scanline y of both images into `memory`, laid out by WarpedPairLayout.
  void warp(int y, std::span<float> scratch, float* memory) const;

  /// Whether blend() can be called: colours are interpolated in rectified images.
  [[nodiscard]] bool blends() const;
  /// blend_row() of what warp() makes of scanline y, in one go: only the disparities are written to
  /// `memory`. Returns the number of holes.
  int blend(int y, const kernels::BlendWeights& weights, std::span<float> scratch, float* memory,
            const kernels::BlendedRow<T>& view) const;

 private:
  struct SourceRow;
  [[nodiscard]] std::size_t source_row_floats() const;
  [[nodiscard]] std::array<SourceRow, 2> source_rows(int y, std::span<float> scratch) const;
  kernels::BicubicFetchRow map_forward(const SourceRow& row, float* warped_disparity_px) const;
  void warp_one(const SourceRow& row, float* colours, float* warped_disparity_px) const;
  void warp_from_photograph(const SurfaceColours<T>& from, int y, double camera_offset,
                            std::span<float> scratch, float* colours,
                            float* warped_disparity_px) const;

  const StereoSource<T>& source_;
  const SynthesisOptions& options_;
  double view_x_;
};

/// Warps both images of a pair to any new view, each by an ImageWarper. At the position of its own
/// camera an image is transformed by the homography alone, without tears.
///
/// Thread rule: warp() may be called concurrently. Does not own any memory it is given, which must
/// outlive it. T is uint8_t, uint16_t or float.
template <typename T>
class SurfaceWarper {
 public:
  /// Maps both images' disparities, in parallel. Errors as ImageWarper.
  SurfaceWarper(const StereoSource<T>& source, const SynthesisOptions& options, const NewView& view,
                Execution& execution);

  /// Bytes held for a view from images of this size.
  static std::size_t working_bytes(const NewView& view, int source_width, int source_height);

  [[nodiscard]] int width() const { return left_.width(); }
  [[nodiscard]] int height() const { return left_.height(); }
  [[nodiscard]] double alpha() const { return alpha_; }

  /// Scratch memory of one call of warp(), in floats; not kept between calls.
  [[nodiscard]] std::size_t scratch_floats() const { return left_.scratch_floats(); }

  /// Warps both images to row y of the new view, into `memory`, laid out by WarpedPairLayout.
  void warp(int y, std::span<float> scratch, float* memory) const;

  /// Coverage of a surface's outline from both images; see EdgeCoverage.
  [[nodiscard]] double coverage(const SurfaceEdge& edge) const;

 private:
  double alpha_;
  ImageWarper<T> left_;
  ImageWarper<T> right_;
};

}  // namespace vantage
