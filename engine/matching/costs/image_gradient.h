#pragma once

#include <cstddef>

#include "engine/execution.h"
#include "engine/matching/costs/intensity_planes.h"
#include "engine/matching/parameters/method_parameters.h"

namespace vantage {

/// Margins before and after the image that filtering needs; the one after includes what kernels
/// read in whole vectors.
inline constexpr int kFilterMarginBefore = 4;
inline constexpr int kFilterMarginAfter = 4 + kernels::kLaneMultiple;

/// Floats of working memory for filtering one row.
std::size_t filter_work_floats(int width);

/// An image to filter: at least the margins above, which must be filled.
struct FilterSource {
  const IntensityPlane<float>& intensities;
  int width;
  int height;
};

/// Gaussian prefilter of chapter 5: σ = ½, radius 2. `smooth`: size and margins as `image`; margins
/// are written. The border is replicated. Identical for any `execution`.
void smooth_intensities(const FilterSource& image, Execution& execution,
                        IntensityPlane<float>& smooth);

/// Components of the gradient (5.9) of row y: correlations with the derivative filters of EQUATIONS
/// §2, borders replicated. gx and gy may be written up to a lane multiple past the width. `work`:
/// filter_work_floats().
void gradient_row(const FilterSource& image, int y, GradientFilter filter, float* work, float* gx,
                  float* gy);

}  // namespace vantage
