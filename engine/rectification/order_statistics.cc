#include "engine/rectification/order_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace vantage {

double percentile(std::vector<double> values, double share) {
  const auto index = std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

double upper_median(std::vector<double> values) { return percentile(std::move(values), 0.5); }

}  // namespace vantage
