#pragma once

#include <vector>

namespace vantage {

/// The value of `values`, which must not be empty, that is nearest by rank to the share `share`, 0
/// to 1, of the sorted values.
[[nodiscard]] double percentile(std::vector<double> values, double share);

/// The median of `values`, which must not be empty; the upper one of the two middle values.
[[nodiscard]] double upper_median(std::vector<double> values);

}  // namespace vantage
