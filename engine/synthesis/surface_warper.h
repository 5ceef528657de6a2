#pragma once

#include <cstddef>
#include <span>

#include "engine/execution.h"
#include "engine/synthesis/image_warper.h"
#include "engine/synthesis/row_pair_warper.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/view_geometry/new_view.h"

namespace vantage {

/// Brings both images of a pair to any new view, each by an ImageWarper. At the place of its own
/// camera an image appears as the homography alone moves it: nothing is torn there.
///
/// Thread rule: warp() may be called concurrently. Does not own any memory it is given, which must
/// outlive it. T is uint8_t, uint16_t or float.
template <typename T>
class SurfaceWarper {
 public:
  /// Maps both images' disparities, in parallel. Errors as ImageWarper.
  SurfaceWarper(const StereoSource<T>& source, const SynthesisOptions& options, const NewView& view,
                Execution& execution);

  /// Memory that it holds for a view from images of this size.
  static std::size_t working_bytes(const NewView& view, int source_width, int source_height);

  [[nodiscard]] int width() const { return left_.width(); }
  [[nodiscard]] int height() const { return left_.height(); }
  [[nodiscard]] double alpha() const { return alpha_; }

  /// What a call of warp() works in; it holds nothing afterwards.
  [[nodiscard]] std::size_t scratch_floats() const { return left_.scratch_floats(); }

  /// Row y of the new view from both images, in `memory`, laid out as WarpedPairLayout has it.
  void warp(int y, std::span<float> scratch, float* memory) const;

  /// What both images together know of a surface's outline; see EdgeCoverage.
  [[nodiscard]] double coverage(const SurfaceEdge& edge) const;

 private:
  double alpha_;
  ImageWarper<T> left_;
  ImageWarper<T> right_;
};

}  // namespace vantage
