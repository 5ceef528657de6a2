#pragma once

#include <cmath>

namespace vantage {
inline namespace test {

/// Keys' cubic convolution kernel, a = −½, as the paper defines it.
inline double keys(double t) {
  t = std::abs(t);
  if (t < 1) {
    return 1.5 * t * t * t - 2.5 * t * t + 1;
  }
  return t < 2 ? -0.5 * t * t * t + 2.5 * t * t - 4 * t + 2 : 0;
}

}  // namespace test
}  // namespace vantage
