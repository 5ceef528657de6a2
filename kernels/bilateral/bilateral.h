#pragma once

#include <array>

namespace vantage::kernels {

inline constexpr int kBilateralRadius = 3;
inline constexpr int kBilateralSide = 2 * kBilateralRadius + 1;
/// Columns are made in multiples of this.
inline constexpr int kBilateralColumns = 16;

/// One row of bilateral smoothing (Tomasi & Manduchi, ICCV 1998) with Tukey's biweight: the mean of
/// 7×7 pixels, weighted by their distance and, where they differ by d from the centre, by
/// (1 − (d / cut_off)²)², 0 from the cut-off on.
struct BilateralRow {
  /// Rows y − 3 to y + 3, readable from column −3 to width_in_whole_columns() + 2.
  std::array<const float*, kBilateralSide> rows{};
  int width = 0;
  float cut_off = 1;  ///< > 0
  /// Weights by distance, [v][u], 1 in the middle.
  std::array<std::array<float, kBilateralSide>, kBilateralSide> weights{};
  float* output = nullptr;  ///< writable up to width_in_whole_columns(); not one of the rows

  [[nodiscard]] constexpr int width_in_whole_columns() const {
    return (width + kBilateralColumns - 1) / kBilateralColumns * kBilateralColumns;
  }
};

/// Identical on every instruction set.
void bilateral_row(const BilateralRow& row);

}  // namespace vantage::kernels
