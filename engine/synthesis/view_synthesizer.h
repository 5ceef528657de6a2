#pragma once

#include <array>
#include <cstddef>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/synthesis/intensity_fit.h"
#include "engine/synthesis/synthesis_options.h"

namespace vantage {

/// One new view and how it came about. Reused from call to call without allocating.
struct SynthesizedView {
  Photograph image;                       ///< size, depth and channels of the left photograph
  Mask holes;                             ///< 255 where neither image is defined, before filling
  std::array<IntensityFit, 4> intensity;  ///< per channel; a = 0, b = 1 where degenerate or alpha
  double hole_fraction = 0;               ///< share of all positions
};

/// Renders new views on the baseline from a rectified pair and its two disparity maps
/// (EQUATIONS §6, YS = 0).
///
/// Every scanline stands for itself: both are forward-mapped (3.5), their colours regressed on each
/// other over the whole image (3.9–3.11), combined (3.12–3.14), and the holes filled. At XS = 0 and
/// 1 the view shows that camera's own pixels wherever its map is known; with γ = α unaltered. A row
/// that neither image reaches takes the nearest row that has pixels, unless holes are left black
/// (all channels 0). An alpha channel is warped and blended like a colour, but not regressed.
///
/// Thread rule: synthesize() may be called concurrently for different results. Results are
/// identical for any ExecutionOptions and on any instruction set.
class ViewSynthesizer {
 public:
  /// Throws UsageError for invalid options. `execution` must outlive the synthesizer.
  ViewSynthesizer(const SynthesisOptions& options, Execution& execution);

  /// left, right: equal size, depth and channels. Maps: same size, NaN or ±inf = unknown (such
  /// pixels are not warped). view_x = XS in baselines, 0 = left camera, 1 = right camera; within
  /// ±16. `view` shares no memory with the inputs. Throws Error when shapes differ, UsageError for
  /// a view_x out of range. `given_fit`: takes the place of the regression, also where the options
  /// do without one.
  void synthesize(const Photograph& left, const Photograph& right,
                  ImageView<const float> left_disparity, ImageView<const float> right_disparity,
                  double view_x, SynthesizedView& view,
                  const std::array<IntensityFit, 4>* given_fit = nullptr) const;

  /// The sums of the regression (3.11) at view_x, in grey levels: those of several pairs can be
  /// added up for one fit_channels(sums, channels, 1). Errors as synthesize(). Identical for any
  /// execution.
  [[nodiscard]] kernels::IntensitySums intensity_sums(const Photograph& left,
                                                      const Photograph& right,
                                                      ImageView<const float> left_disparity,
                                                      ImageView<const float> right_disparity,
                                                      double view_x) const;

  /// Memory that synthesize() works in for an image of this shape, unless it is given a fit; beside
  /// rows per thread.
  [[nodiscard]] static std::size_t working_bytes(int width, int height, int channels);

  [[nodiscard]] const SynthesisOptions& options() const { return options_; }

 private:
  SynthesisOptions options_;
  Execution& execution_;
};

}  // namespace vantage
