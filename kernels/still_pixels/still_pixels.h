#pragma once

#include <cstdint>

namespace vantage::kernels {

/// int16 rows that the functions below write and read back. Values [−1, width] are used; x = 0 is
/// kStillMargin values after the start of the memory, which holds still_row_values(width) values.
inline constexpr int kStillMargin = 64;
inline int still_row_values(int width) {
  return (width + kStillMargin - 1) / kStillMargin * kStillMargin + 2 * kStillMargin;
}

/// One row of two frames, with the rows above and below (the row itself where there is none). Each
/// must be readable up to the first multiple of kStillMargin ≥ width.
struct FrameRows {
  const std::uint8_t* now[3] = {};
  const std::uint8_t* before[3] = {};
  int width = 0;  ///< ≥ 1
};

/// change[x] = |Σ (now − before)| over 3×3 pixels, columns clamped at the border. `work` and
/// `change`: rows as described above. Equal on every instruction set.
void box_change_row(const FrameRows& rows, std::int16_t* work, std::int16_t* change);

/// still[x] = 255 if no change in 3×3 pixels exceeds `limit`, else 0. May write up to the first
/// multiple of kStillMargin ≥ width. limit < 32767. `changes`: the row above, the row and the row
/// below (the row itself where there is none). Equal on every instruction set.
void still_row(const std::int16_t* const changes[3], int width, std::int16_t limit,
               std::uint8_t* still);

}  // namespace vantage::kernels
