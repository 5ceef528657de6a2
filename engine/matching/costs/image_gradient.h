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

/// Gaussian prefilter of chapter 5: σ = ½, radius 2. All planes have the size width × height and
/// at least the margins above. The margins of `intensities` must be filled; those of `smooth` are
/// written. The border is replicated. Identical for any `execution`.
void smooth_intensities(const IntensityPlane<float>& intensities, int width, int height,
                        Execution& execution, IntensityPlane<float>& smooth);

/// Components of the gradient (5.9) of row y: correlations with the derivative filters of EQUATIONS
/// §2, borders replicated. `intensities`: size and margins as above. gx and gy may be written up to
/// a lane multiple past the width. `work`: filter_work_floats().
void gradient_row(const IntensityPlane<float>& intensities, int width, int height, int y,
                  GradientFilter filter, float* work, float* gx, float* gy);

}  // namespace vantage
