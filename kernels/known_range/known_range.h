#pragma once

#include <limits>

namespace vantage::kernels {

/// Least and largest of known disparities; least > most where there are none.
struct KnownRange {
  float least = std::numeric_limits<float>::infinity();
  float most = -std::numeric_limits<float>::infinity();
};

/// `range` widened by the values of a row, of which NaN and ±inf are unknown. Identical on every
/// instruction set and to the reference.
KnownRange known_range_row(const float* disparity_px, int count, KnownRange range);
KnownRange known_range_row_ref(const float* disparity_px, int count, KnownRange range);

}  // namespace vantage::kernels
