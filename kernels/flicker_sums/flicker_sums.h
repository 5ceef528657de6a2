#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Change between one row of two disparity maps.
struct DisparityChange {
  /// Pixels where `mask` is set and both disparities are known.
  std::int64_t compared = 0;
  std::int64_t jumped = 0;  ///< of these: |difference| > 1 px
  std::int64_t change = 0;  ///< Σ min(|difference|, 1024) in 1/1024 px, each rounded
  /// Range of all known disparities of both maps; +infinity and −infinity if there are none.
  float min_px = 0;
  float max_px = 0;
};

/// Change between one row of two images of grey levels.
struct IntensityChange {
  std::int64_t compared = 0;  ///< pixels where `mask` is set
  std::int64_t change = 0;    ///< Σ |difference| over them
};

/// NaN: unknown; mask: 255 or 0. All functions equal the reference on every instruction set.
DisparityChange disparity_change_row(const float* now_px, const float* before_px,
                                     const std::uint8_t* mask, int width);
DisparityChange disparity_change_row_ref(const float* now_px, const float* before_px,
                                         const std::uint8_t* mask, int width);

IntensityChange intensity_change_row(const std::uint8_t* now, const std::uint8_t* before,
                                     const std::uint8_t* mask, int width);
IntensityChange intensity_change_row_ref(const std::uint8_t* now, const std::uint8_t* before,
                                         const std::uint8_t* mask, int width);

/// Σ levels.
std::int64_t intensity_sum_row(const std::uint8_t* levels, int width);
std::int64_t intensity_sum_row_ref(const std::uint8_t* levels, int width);

}  // namespace vantage::kernels
