#pragma once

#include <cstddef>

#include "kernels/source_position/source_position.h"

namespace vantage::kernels {

/// An image as far as the extents of its surfaces are concerned.
struct CoverageSource {
  SourceProjection way_back;
  const float* disparity_px = nullptr;  ///< of pixel (0, 0)
  std::ptrdiff_t stride = 0;            ///< values from one row to the next
  int width = 0;                        ///< ≥ 1
  int height = 0;                       ///< ≥ 1
  float gradient_limit_px = 1;          ///< disparities that differ by more are other surfaces
};

/// How much of the new view's pixel (u, v) a surface of nearness q covers, 0..1, as one image knows
/// it: where this pixel comes from if it shows the surface, the share of the image's pixels around
/// that do. Half a pixel beyond the last pixel it is ½, and straight outlines are straight.
///
/// An image tells its outlines to half a pixel. Pixels around are therefore weighted by the
/// quadratic B-spline, which is the mean over what is possible. What the image itself shows at its
/// outlines is right as long as the surface and what lies behind it, of nearness
/// `background_nearness`, come from the same place. Weights are then bilinear, so that they are 0
/// and 1 at whole pixels, and change to the spline as the two come to lie two pixels apart. Pixels
/// outside the image are as those at its border.
///
/// NaN where the place is behind the image's camera. Plain code: outlines are few. Thread rule:
/// pure. Identical on every instruction set.
double surface_coverage(const CoverageSource& source, double u, double v, double nearness,
                        double background_nearness);

/// What two images together know: `first` and `second` are what each says, NaN = does not show the
/// surface. One alone is right; NaN if there is none. `alpha`, 0..1, is the weight of the first.
/// Where both count alike they are two independent observations, of which odds are multiplied (so
/// one that is certain prevails); the more one prevails by weight, the more it is their mean.
double joint_coverage(double alpha, double first, double second);

}  // namespace vantage::kernels
