#pragma once

#include <array>
#include <cstddef>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/synthesis/intensity_fit.h"
#include "engine/synthesis/synthesis_options.h"
#include "engine/synthesis/triple_warper.h"
#include "engine/synthesis/unrectified_pair.h"
#include "engine/view_geometry/new_view.h"

namespace vantage {

/// A new view and statistics of its synthesis. Can be reused without reallocation, except for views
/// reduced from several samples per pixel.
struct SynthesizedView {
  Photograph image;  ///< depth and channels of the left photograph
  Mask holes;        ///< 255 where neither image is defined, before filling
  /// Sources of a pixel: 0 none (filled or black), 85 the left image, 170 the right one, 255 both.
  /// With three images, 85 is the combined first two.
  Mask sources;
  std::array<IntensityFit, 4> intensity;  ///< per channel; a = 0, b = 1 where degenerate or alpha
  double hole_fraction = 0;               ///< share of all pixels
};

/// Three photographs of one size, depth and number of channels whose cameras are in one plane and
/// have the same orientation, and their disparity maps, in pixels for one common baseline. Nothing
/// is owned.
struct PhotographTriple {
  std::array<const Photograph*, 3> images{};
  std::array<ImageView<const float>, 3> disparity_px;
};

/// Intensity regressions among three photographs.
struct TripleFit {
  std::array<IntensityFit, 4> second_on_first;
  std::array<IntensityFit, 4> third_on_others;  ///< on the combined first two in the view
};

/// Renders new views from a rectified pair and its two disparity maps (EQUATIONS §6).
///
/// Both images are warped to the view: along scanlines if it is on the baseline with the images'
/// orientation (RowPairWarper), else in one pass through all homographies (SurfaceWarper). Their
/// colours are regressed on each other over rows of the whole view (3.9–3.11), combined
/// (3.12–3.14), and the holes filled along its scanlines. Images show the same surface if their
/// disparities, or off the baseline their nearness (NewView), agree within the gradient limit.
/// Views that reduce the images are made of several samples per pixel (view_sampling.h). At a
/// camera's position, XS = 0 or 1, the view shows that camera's own photograph wherever its map is
/// known, transformed by the homography alone; with γ = α, the default, unaltered. A row without
/// pixels from either image copies the nearest row that has some, unless holes are left black (all
/// channels 0). An alpha channel is warped and blended like a colour, but not regressed.
///
/// Thread rule: synthesize() may be called concurrently for different results. Results are
/// identical for any ExecutionOptions and on any instruction set.
class ViewSynthesizer {
 public:
  /// Throws UsageError for invalid options. `execution` must outlive the synthesizer.
  ViewSynthesizer(const SynthesisOptions& options, Execution& execution);

  /// left, right: equal size, depth and channels. Maps: same size, NaN or ±inf = unknown (such
  /// pixels are not warped). The result has the view's size and shares no memory with the inputs.
  /// `given_fit` replaces the regression, even if the options disable it. With WarpColour::kForward
  /// views off the baseline show the nearest source pixel everywhere.
  ///
  /// With photographs that the pair was rectified from, colours come from them: one interpolation
  /// instead of two. Where a photograph shows nothing the rectified image is black, and so is its
  /// share of the view. The options must have WarpColour::kOnePass: the book moves pixels of
  /// rectified images.
  ///
  /// Throws Error when shapes differ, and for a view without pixels, larger than 65500 pixels in
  /// width or height, or that cannot be inverted.
  void synthesize(const ViewSource& source, const NewView& new_view, SynthesizedView& view,
                  const std::array<IntensityFit, 4>* given_fit = nullptr) const;
  /// The view at XS in baselines: baseline_view() of the images' size.
  void synthesize(const ViewSource& source, double view_x, SynthesizedView& view,
                  const std::array<IntensityFit, 4>* given_fit = nullptr) const {
    synthesize(source, baseline_view(view_x, 0, source.left.width(), source.left.height()), view,
               given_fit);
  }

  /// A view among three cameras (TripleWarper), always with γ = α: the brightness follows the
  /// weights and equals a photograph's where its weight is 1. Errors as above.
  void synthesize(const PhotographTriple& triple, const TripleView& new_view, SynthesizedView& view,
                  const TripleFit& fit) const;
  /// The regressions for such views, estimated at `new_view`; identities without match_intensities.
  [[nodiscard]] TripleFit fit_triple(const PhotographTriple& triple,
                                     const TripleView& new_view) const;

  /// The sums of the regression (3.11) in a view, in grey levels: sums of several pairs can be
  /// added for one fit_channels(sums, channels, 1). Errors as synthesize(). Identical for any
  /// execution.
  [[nodiscard]] kernels::IntensitySums intensity_sums(const ViewSource& source,
                                                      const NewView& new_view) const;
  [[nodiscard]] kernels::IntensitySums intensity_sums(const ViewSource& source,
                                                      double view_x) const {
    return intensity_sums(source,
                          baseline_view(view_x, 0, source.left.width(), source.left.height()));
  }

  /// Upper bound of the working memory of synthesize() in bytes off the baseline, for images of
  /// this shape, besides rows per thread: maps of both images, outlines, samples. On the baseline
  /// it takes none.
  [[nodiscard]] static std::size_t working_bytes(const NewView& view, int width, int height,
                                                 int channels);
  /// Additional bytes for filling the holes.
  [[nodiscard]] static std::size_t filling_bytes(const SynthesisOptions& options, int width,
                                                 int height, int channels);
  /// As above for any view of images of this shape.
  [[nodiscard]] static std::size_t filling_bytes(const SynthesisOptions& options,
                                                 const NewView& view, int width, int height,
                                                 int channels);

  [[nodiscard]] const SynthesisOptions& options() const { return options_; }

 private:
  SynthesisOptions options_;
  Execution& execution_;
};

}  // namespace vantage
