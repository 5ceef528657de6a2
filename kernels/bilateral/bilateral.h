#pragma once

#include <cstdint>
#include <span>

namespace vantage::kernels {

/// Columns are made in multiples of this.
inline constexpr int kBilateralColumns = 32;
/// Grey levels 0..255 are compared in steps of 1/this.
inline constexpr int kBilateralUnit = 128;
/// Limits of the cut-off, in grey levels.
inline constexpr double kMinBilateralCutOff = 4;
inline constexpr double kMaxBilateralCutOff = 180;
inline constexpr int kBilateralOne = 1 << 15;

/// Two neighbours at the same distance on opposite sides of a pixel.
struct BilateralPair {
  const std::int16_t* before = nullptr;  ///< of column 0
  const std::int16_t* after = nullptr;
  std::int16_t weight = 0;  ///< by distance; kBilateralOne is that of the pixel itself
};

/// One row of bilateral smoothing (Tomasi & Manduchi, ICCV 1998) with Tukey's biweight: the mean of
/// a pixel and its neighbours, weighted by their distance and, where they differ by d from it, by
/// (1 − (d / cut_off)²)², 0 from the cut-off on. In fixed point: results are within a quarter of a
/// grey level, and identical on every instruction set.
struct BilateralRow {
  /// Steps of pixels, 0 to 255 · kBilateralUnit, and of their neighbours; readable up to
  /// width_in_whole_columns().
  const std::int16_t* pixels = nullptr;
  std::span<const BilateralPair> pairs = {};
  int width = 0;
  int cut_off = 0;  ///< in steps
  /// Writable up to width_in_whole_columns(); not one of the inputs.
  std::int16_t* output = nullptr;

  [[nodiscard]] constexpr int width_in_whole_columns() const {
    return (width + kBilateralColumns - 1) / kBilateralColumns * kBilateralColumns;
  }
};
void bilateral_row(const BilateralRow& row);

/// Grey levels as steps, to the nearest; clipped to 0 and 32767. Whole columns of both are used.
void bilateral_steps_row(const float* grey_levels, int width, std::int16_t* steps);

}  // namespace vantage::kernels
