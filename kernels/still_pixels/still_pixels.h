#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Rows of int16 that the functions below write and read back: values [−1, width] count, x = 0 is
/// kStillMargin values into the memory, which holds still_row_values(width) of them.
inline constexpr int kStillMargin = 64;
inline int still_row_values(int width) {
  return (width + kStillMargin - 1) / kStillMargin * kStillMargin + 2 * kStillMargin;
}

/// One row of two frames, with the rows above and below it (the row itself where there is none).
/// Each can be read up to the next multiple of kStillMargin behind the width.
struct FrameRows {
  const std::uint8_t* now[3] = {};
  const std::uint8_t* before[3] = {};
  int width = 0;  ///< ≥ 1
};

/// change[x] = |Σ (now − before)| over 3×3 pixels, columns clamped at the border. `work` and
/// `change`: as above. Equal to the reference on every instruction set.
void box_change_row(const FrameRows& rows, std::int16_t* work, std::int16_t* change);
void box_change_row_ref(const FrameRows& rows, std::int16_t* work, std::int16_t* change);

/// still[x] = 255 where no change in 3×3 pixels exceeds `limit`, else 0; up to the next multiple of
/// kStillMargin behind the width may be written. limit < 32767. `changes`: the rows above, of and
/// below, the row itself where there is none. Equal to the reference on every instruction set.
void still_row(const std::int16_t* const changes[3], int width, std::int16_t limit,
               std::uint8_t* still);
void still_row_ref(const std::int16_t* const changes[3], int width, std::int16_t limit,
                   std::uint8_t* still);

/// still_view[x] = 255 where still[x + s] is for all shifts s in [least_shift, most_shift] that
/// lead into the image, and there is one; else 0: pixels of a view that a pixel of the image can
/// have got to only from a still one. least_shift ≤ most_shift.
void still_view_row(const std::uint8_t* still, int width, int least_shift, int most_shift,
                    std::uint8_t* still_view);

}  // namespace vantage::kernels
