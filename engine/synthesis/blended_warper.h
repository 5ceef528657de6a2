#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/synthesis/image_warper.h"
#include "engine/synthesis/intensity_fit.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/new_view.h"

namespace vantage {

/// A photograph that a view is blended from, with the map of its pixels: scale / depth, the scale
/// common to all. Nothing is owned.
struct BlendSource {
  const Photograph* image = nullptr;
  ImageView<const float> disparity_px;
  ViewWarp warp;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of its camera, in the new camera's frame
  double share = 1;  ///< above 0: factor of its weight; of a source that fades out, near 0
  /// Regression of its intensities on those of the first source (identity for the first).
  std::array<IntensityFit, 4> on_first;
};

/// A view blended from several photographs.
struct BlendedView {
  int width_px = 0;
  int height_px = 0;
  Eigen::Matrix3d ray_of_pixel = Eigen::Matrix3d::Identity();  ///< K⁻¹ of the new camera
  double scale_px = 1;  ///< of the maps: a pixel of nearness q is at depth scale / q
};

/// Blends one or more photographs in a new view (3.4), per pixel by angle and visibility: each is
/// weighed by share / (a² · angle), the angle between its ray and the view's at the surface point
/// and a the distance of its camera from the view's ray. So a camera at the view's own position has
/// all the weight, and far ones count little beside near ones that see the surface. Photographs
/// that show another surface there do not count: the surface is the nearest one that at least
/// kMinSupport of the weight of all photographs with a known pixel agree on within the gradient
/// limit, or else that with most weight. A photograph whose surface ends beside the position counts
/// less (BlendWeights::trust_at_ends). The brightness follows the weights over the whole view, not
/// per pixel.
///
/// Thread rule: warp() may be called concurrently. Does not own any memory it is given, which must
/// outlive it. T is uint8_t, uint16_t or float.
template <typename T>
class BlendedWarper {
 public:
  /// Maps the disparities, in parallel. `sources`: at least one. Errors as ImageWarper.
  BlendedWarper(std::span<const BlendSource> sources, const SynthesisOptions& options,
                const BlendedView& view, Execution& execution);

  [[nodiscard]] int width() const { return images_.front().width(); }
  [[nodiscard]] int height() const { return images_.front().height(); }
  /// 1 at the position of a source, where the view is its photograph; else ½, which has no meaning.
  [[nodiscard]] double alpha() const { return is_at_source_ ? 1 : 0.5; }

  /// Scratch memory of one call of warp(), in floats; not kept between calls.
  [[nodiscard]] std::size_t scratch_floats() const;

  /// Row y of the view into the first half of a pair, laid out by WarpedPairLayout; the second half
  /// is holes.
  void warp(int y, std::span<float> scratch, float* memory) const;

  /// Coverage of a surface's outline from all images; see EdgeCoverage.
  [[nodiscard]] double coverage(const SurfaceEdge& edge) const;

 private:
  struct Transform {
    std::array<float, 4> scale{1, 1, 1, 1};
    std::array<float, 4> offset{};
  };
  [[nodiscard]] std::size_t floats_per_image() const;
  [[nodiscard]] bool goes_on(const float* nearness, int x) const;

  BlendedView view_;
  bool is_at_source_ = false;
  float trust_at_ends_;
  float gradient_limit_px_;
  std::vector<BlendSource> sources_;
  std::vector<double> weights_;  ///< over the whole view; their sum is 1
  double farthest_;              ///< of the cameras, from the view's
  std::vector<Transform> transforms_;
  std::deque<ImageWarper<T>> images_;
};

/// Renders views blended from several photographs of one size, depth and number of channels.
///
/// Thread rule: as ViewSynthesizer.
class BlendedSynthesizer {
 public:
  /// Throws UsageError for invalid options. `execution` must outlive the synthesizer.
  BlendedSynthesizer(const SynthesisOptions& options, Execution& execution);

  /// Errors as ViewSynthesizer::synthesize().
  void synthesize(std::span<const BlendSource> sources, const BlendedView& new_view,
                  SynthesizedView& view) const;

 private:
  SynthesisOptions options_;
  Execution& execution_;
};

}  // namespace vantage
