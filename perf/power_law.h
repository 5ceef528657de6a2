#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace vantage::perf {

/// y = factor · x^exponent, least-squares fit of the logarithms.
struct PowerLaw {
  double exponent = 0;
  double standard_error = 0;  ///< of the exponent
};

/// Requires at least three points with differing x; x and y > 0.
inline PowerLaw fit_power_law(const std::vector<double>& x, const std::vector<double>& y) {
  const auto count = static_cast<double>(x.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / count;
    mean_y += std::log(y[i]) / count;
  }
  double xx = 0;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double from_mean = std::log(x[i]) - mean_x;
    xx += from_mean * from_mean;
    xy += from_mean * (std::log(y[i]) - mean_y);
  }
  const double exponent = xy / xx;
  double residuals = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double residual = std::log(y[i]) - mean_y - exponent * (std::log(x[i]) - mean_x);
    residuals += residual * residual;
  }
  return {exponent, std::sqrt(residuals / (count - 2) / xx)};
}

}  // namespace vantage::perf
