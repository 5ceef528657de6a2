#pragma once

#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Root of the mean squared difference of grey levels (luma) for each displacement left − right
/// (5.5.1), over the pixels of the left image that have a partner; NaN for displacements without
/// any. Rows of equal y displacement, contiguous, starting at the smallest. Throws Error when sizes
/// differ. Identical for any `execution`.
std::vector<double> rms_differences(const Photograph& left, const Photograph& right,
                                    DisparityRange displacements_x, DisparityRange displacements_y,
                                    Execution& execution);

}  // namespace vantage
