#pragma once

#include "engine/image/image.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// Whether (x, y) is a still pixel of two frames, by the definition: the largest mean difference
/// over 3×3 pixels among the 3×3 pixels around.
inline bool is_still(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b, int x, int y,
                     double threshold) {
  const auto column = [&](int c) { return std::clamp(c, 0, a.width() - 1); };
  const auto row = [&](int r) { return std::clamp(r, 0, a.height() - 1); };
  for (int v = y - 1; v <= y + 1; ++v) {
    for (int u = x - 1; u <= x + 1; ++u) {
      double sum = 0;
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          sum += a.at(column(column(u) + i), row(row(v) + j)) -
                 b.at(column(column(u) + i), row(row(v) + j));
        }
      }
      if (std::abs(sum) / 9 > threshold + 1e-9) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace test
}  // namespace vantage
