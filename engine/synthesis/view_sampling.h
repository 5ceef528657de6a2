#pragma once

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/view_geometry/new_view.h"

namespace vantage {

struct SynthesizedView;

/// How a view that reduces the images is sampled. Each of its pixels shows several of theirs, so it
/// is rendered at a multiple of its size, and that is reduced: colours and outlines alike.
struct ViewSampling {
  int samples = 1;  ///< per pixel and side
  /// How many pixels of the images, which are means over their own area, one of the view is wide.
  double reduction = 1;
};

/// Of `view`: as many samples, 1..8, as make each hardly wider than a pixel of the images. The
/// reduction is that of what the maps show, along the direction in which it is most, and its mean
/// over the view. One sample for views that do not reduce.
[[nodiscard]] ViewSampling view_sampling(const NewView& view,
                                         ImageView<const float> left_disparity_px,
                                         ImageView<const float> right_disparity_px);

/// At most as many samples per side, whatever maps of that size show.
[[nodiscard]] int most_samples_per_side(const NewView& view, int source_width, int source_height);

/// The view with samples × samples pixels in the place of each.
[[nodiscard]] NewView with_samples(const NewView& view, int samples);

/// `view` from `fine`, rendered with `sampling`. A colour is a weighted mean of a pixel's samples
/// and of those next to it, along both axes: with the weights for which the mean is as wide as the
/// pixel, considering that samples have the width of the images' pixels already. Integers are
/// rounded half up. A pixel is a hole where all of its samples are, and made of the images that any
/// of them is made of. Identical for any execution.
void reduce_view(const SynthesizedView& fine, const ViewSampling& sampling, SynthesizedView& view,
                 Execution& execution);

}  // namespace vantage
