#pragma once

#include <vector>

namespace vantage {

/// The element of `values` (not empty) with the rank nearest to the fraction `share`, 0 to 1, of
/// the sorted values.
[[nodiscard]] double percentile(std::vector<double> values, double share);

/// The median of `values` (not empty); for even sizes the upper middle value.
[[nodiscard]] double upper_median(std::vector<double> values);

}  // namespace vantage
