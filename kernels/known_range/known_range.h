#pragma once

#include <limits>

namespace vantage::kernels {

/// Minimum and maximum of the known disparities; least > most if there are none.
struct KnownRange {
  float min = std::numeric_limits<float>::infinity();
  float max = -std::numeric_limits<float>::infinity();
};

/// Extends `range` by the values of a row; NaN and ±inf are unknown. Identical on every instruction
/// set and to the reference.
KnownRange known_range_row(const float* disparity_px, int count, KnownRange range);
KnownRange known_range_row_ref(const float* disparity_px, int count, KnownRange range);

}  // namespace vantage::kernels
