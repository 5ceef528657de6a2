#pragma once

#include <cstddef>

#include "kernels/source_position/source_position.h"

namespace vantage::kernels {

/// An image and its disparities, for the extents of its surfaces.
struct CoverageSource {
  SourceProjection way_back;
  const float* disparity_px = nullptr;  ///< at pixel (0, 0)
  std::ptrdiff_t stride = 0;            ///< values between rows
  int width = 0;                        ///< ≥ 1
  int height = 0;                       ///< ≥ 1
  float gradient_limit_px = 1;          ///< disparities that differ by more are on other surfaces
};

/// Fraction of the new view's pixel (u, v) that a surface of nearness q covers, 0..1, according to
/// one image: the fraction of image pixels that show the surface, around the position that this
/// pixel comes from if it does. It is ½ half a pixel beyond the last pixel, and straight outlines
/// stay straight.
///
/// An image locates its outlines to half a pixel. Surrounding pixels are therefore weighted by the
/// quadratic B-spline, the mean over all possible outlines. What the image itself shows at its
/// outlines is correct as long as the surface and its background, of nearness
/// `background_nearness`, come from the same place. Weights are then bilinear, so that coverage is
/// 0 or 1 at whole pixels; they change to the spline as the two move two pixels apart. Pixels
/// outside the image equal those at its border.
///
/// NaN if the position is behind the image's camera. Scalar code only: outlines are few. Thread
/// rule: pure. Identical on every instruction set.
double surface_coverage(const CoverageSource& source, double u, double v, double nearness,
                        double background_nearness);

/// Combined coverage of two images: `first` and `second` are their values, NaN = does not show the
/// surface. A single value is returned as it is; NaN if there is none. `alpha`, 0..1, is the weight
/// of the first. With equal weights the two are independent observations whose odds are multiplied,
/// so a certain one prevails; the more the weights differ, the closer the result is to the weighted
/// mean.
double joint_coverage(double alpha, double first, double second);

}  // namespace vantage::kernels
