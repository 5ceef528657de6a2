#pragma once

#include <cstddef>
#include <span>

#include "engine/execution.h"
#include "engine/synthesis/image_warper.h"
#include "engine/synthesis/row_pair_warper.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/view_geometry/new_view.h"

namespace vantage {

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
