#pragma once

#include <cstdint>

namespace vantage::kernels {

// Column sums of squared differences (§1): cell (x, i) of row y holds
//   Σ over rows y−r … y+r of (I_ref(x) − I_other(partner of x at candidate i))²
// in units of 4^-shift, and moves from row to row by one row that enters and one that leaves. The
// rows may be absent (outside the image).

/// Interleaves two rows of 8-bit pixels, multiplied by 2^shift (0 ≤ shift ≤ 6), into `count` pairs
/// of 16-bit numbers: entering in the low half of 32 bits, leaving in the high half. Either row may
/// be null: its halves are then 0. May write behind them, up to the next multiple of kLaneMultiple;
/// the inputs need to be readable as far.
void interleave_rows(const std::uint8_t* entering, const std::uint8_t* leaving, int shift,
                     int count, std::int32_t* pairs);

/// One step of the column sums of 8-bit images, whose entering and leaving rows are interleaved so
/// that one multiply-add of pairs yields both squares. Candidate i of column j compares pair
/// reference[j] with pair partner[j · partner_step + i]; lanes is a multiple of kLaneMultiple.
struct ColumnSsdPairs {
  const std::int32_t* reference = nullptr;
  const std::int32_t* partner = nullptr;  ///< of candidate 0 of the first column
  int partner_step = 1;  ///< +1 or −1; −1 for a left reference, whose partner row is mirrored
  int columns = 0;
  int lanes = 0;
};

/// sums[j · lanes + i] = previous[…] + entering² − leaving². Exact modulo 2³². `previous` may be
/// the same row as `sums`. Identical on every instruction set.
void column_ssd_row(const ColumnSsdPairs& row, const std::int32_t* previous, std::int32_t* sums);
void column_ssd_row_ref(const ColumnSsdPairs& row, const std::int32_t* previous,
                        std::int32_t* sums);

/// Squares of float differences must stay below this.
inline constexpr float kFloatSquareLimit = 4194304.0F;  // 2²²

/// The same for float images, scaled by the caller so that squares stay below kFloatSquareLimit;
/// each square is rounded to the nearest integer (ties to even), so sums stay exact.
struct ColumnSsdFloat {
  const float* reference_entering = nullptr;  ///< of the first column; null with partner_entering
  const float* reference_leaving = nullptr;
  const float* partner_entering = nullptr;  ///< of candidate 0 of the first column
  const float* partner_leaving = nullptr;
  int partner_step = 1;
  int columns = 0;
  int lanes = 0;
};

void column_ssd_row(const ColumnSsdFloat& row, const std::int32_t* previous, std::int32_t* sums);
void column_ssd_row_ref(const ColumnSsdFloat& row, const std::int32_t* previous,
                        std::int32_t* sums);

}  // namespace vantage::kernels
