#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <vector>

#include "engine/image/image.h"

namespace vantage {

/// Adds the finite values of a map, row by row, to `values`. Thread rule: pure.
inline void add_finite_values(ImageView<const float> map, std::vector<float>& values) {
  for (int y = 0; y < map.height(); ++y) {
    std::copy_if(map.row(y), map.row(y) + map.width(), std::back_inserter(values),
                 [](float value) { return std::isfinite(value); });
  }
}

/// Those of one map: its known values.
inline std::vector<float> finite_values(ImageView<const float> map) {
  std::vector<float> values;
  // At once: growing would take twice the memory.
  values.reserve(static_cast<std::size_t>(map.width()) * static_cast<std::size_t>(map.height()));
  add_finite_values(map, values);
  return values;
}

/// The map with NaN for all values that are not finite.
inline Image<float> with_nan(ImageView<const float> map) {
  Image<float> result(map.width(), map.height());
  for (int y = 0; y < map.height(); ++y) {
    std::transform(map.row(y), map.row(y) + map.width(), result.row(y), [](float value) {
      return std::isfinite(value) ? value : std::numeric_limits<float>::quiet_NaN();
    });
  }
  return result;
}

}  // namespace vantage
