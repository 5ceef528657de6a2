#pragma once

namespace vantage {

/// Signed, inclusive range of candidate disparities in pixels, d = x_left − x_right.
struct DisparityRange {
  int min = 0;
  int max = 63;
  [[nodiscard]] int count() const { return max - min + 1; }
  friend bool operator==(DisparityRange, DisparityRange) = default;
};

}  // namespace vantage
