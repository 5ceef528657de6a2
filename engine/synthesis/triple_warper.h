#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/synthesis/image_warper.h"
#include "engine/synthesis/intensity_fit.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/view_geometry/new_view.h"

namespace vantage {

/// Three rectified photographs of one depth and their disparity maps, all of equal size.
/// Disparities refer to one common baseline.
template <typename T>
struct TripleSource {
  std::array<ImageView<const T>, 3> images;
  std::array<ImageView<const float>, 3> disparity_px;
};

/// A new view inside or outside the triangle of three cameras.
struct TripleView {
  int width_px = 0;
  int height_px = 0;
  std::array<ViewWarp, 3> from;
  /// Shares of the three images where all show one surface; each within 0..1, their sum is 1.
  std::array<double, 3> weights{1.0 / 3, 1.0 / 3, 1.0 / 3};

  /// Share of the first image relative to the second, and of both relative to the third. Exactly 0
  /// or 1 only if one camera has all the weight: the view is then its own, and the others fill its
  /// holes. Otherwise they stay slightly inside (0, 1), so that views do not change abruptly on the
  /// sides of a triangle.
  [[nodiscard]] double alpha_of_first() const;
  [[nodiscard]] double alpha_of_first_two() const;
};

/// Warps three photographs to a new view and combines the first two there, which leaves a pair:
/// repeated interpolation in a triangle of views (3.4). Of different surfaces the nearer one is
/// kept; positions that only one of them sees are taken from it (3.12–3.14 with γ = α).
///
/// Thread rule: warp() may be called concurrently. Does not own any memory it is given, which must
/// outlive it. T is uint8_t, uint16_t or float.
template <typename T>
class TripleWarper {
 public:
  /// Maps the disparities, in parallel. `second_on_first`: regression of the second image's
  /// intensities on the first's. Errors as ImageWarper.
  TripleWarper(const TripleSource<T>& source, const std::array<IntensityFit, 4>& second_on_first,
               const SynthesisOptions& options, const TripleView& view, Execution& execution);

  [[nodiscard]] int width() const { return images_[0].width(); }
  [[nodiscard]] int height() const { return images_[0].height(); }
  /// Share of the combined first two relative to the third.
  [[nodiscard]] double alpha() const { return alpha_; }

  /// Scratch memory of one call of warp(), in floats; not kept between calls.
  [[nodiscard]] std::size_t scratch_floats() const;

  /// Warps row y of the new view from the combined first two and from the third image into
  /// `memory`, laid out by WarpedPairLayout.
  void warp(int y, std::span<float> scratch, float* memory) const;

  /// Coverage of a surface's outline from all images; see EdgeCoverage.
  [[nodiscard]] double coverage(const SurfaceEdge& edge) const;

 private:
  /// scale · I + offset per channel.
  struct Transform {
    std::array<float, 4> scale{1, 1, 1, 1};
    std::array<float, 4> offset{};
  };
  void transform(const Transform& by, float* colours) const;

  double alpha_;
  double alpha_of_first_;
  float trust_at_ends_;  // of either of the first two, see BlendWeights
  float gradient_limit_px_;
  std::array<ImageWarper<T>, 3> images_;
  Transform first_;
  Transform second_;
};

}  // namespace vantage
