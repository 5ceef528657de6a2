#pragma once

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/view_geometry/new_view.h"

namespace vantage {

struct SynthesizedView;

/// Supersampling of a view that reduces the images. Each of its pixels covers several image pixels,
/// so the view is rendered at a multiple of its size and then reduced, colours and outlines alike.
struct ViewSampling {
  int samples = 1;  ///< per pixel and side
  /// Width of a pixel of the view in image pixels, which are means over their own area.
  double reduction = 1;
};

/// Sampling of `view`: the number of samples, 1..8, that makes each hardly wider than an image
/// pixel. The reduction is that of the mapped pixels along its strongest direction, averaged over
/// the view. One sample for views that do not reduce.
[[nodiscard]] ViewSampling view_sampling(const NewView& view,
                                         ImageView<const float> left_disparity_px,
                                         ImageView<const float> right_disparity_px);

/// Upper bound of the samples per side, for any maps of that size.
[[nodiscard]] int max_samples_per_side(const NewView& view, int source_width, int source_height);

/// The view with samples × samples pixels for each of its pixels.
[[nodiscard]] NewView with_samples(const NewView& view, int samples);

/// Reduces `fine`, rendered with `sampling`, to `view`. A colour is a weighted mean of a pixel's
/// samples and the adjacent ones along both axes, with weights that make the mean as wide as the
/// pixel, given that samples already have the width of image pixels. Integers are rounded half up.
/// A pixel is a hole if all of its samples are; its sources are the union of its samples' sources.
/// Identical for any execution.
void reduce_view(const SynthesizedView& fine, const ViewSampling& sampling, SynthesizedView& view,
                 Execution& execution);

}  // namespace vantage
