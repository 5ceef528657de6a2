#pragma once

#include <cstdint>

namespace vantage::kernels {

// Column sums of squared differences (§1): cell (x, i) of row y holds
//   Σ over rows y−r … y+r of (I_ref(x) − I_other(partner of x at candidate i))²
// in units of 4^-shift. From row to row, one row enters the sums and one leaves. Either may be
// absent (outside the image).

/// Interleaves two rows of 8-bit pixels, multiplied by 2^shift (0 ≤ shift ≤ 6), into `count` pairs
/// of 16-bit numbers: entering in the low half of 32 bits, leaving in the high half. Either row may
/// be null; its halves are then 0. May write up to the next multiple of kLaneMultiple; the inputs
/// must be readable that far.
void interleave_rows(const std::uint8_t* entering, const std::uint8_t* leaving, int shift,
                     int count, std::int32_t* pairs);

/// One step of the column sums of 8-bit images. Entering and leaving rows are interleaved so that
/// one multiply-add of pairs yields both squares. Candidate i of column j compares pair
/// reference[j] with pair partner[j · partner_step + i]. lanes is a multiple of kLaneMultiple.
struct ColumnSsdPairs {
  const std::int32_t* reference = nullptr;
  const std::int32_t* partner = nullptr;  ///< at candidate 0 of the first column
  int partner_step = 1;  ///< +1; −1 for a left reference, whose partner row is mirrored
  int columns = 0;
  int lanes = 0;
};

/// sums[j · lanes + i] = previous[…] + entering² − leaving². Exact modulo 2³². `previous` may be
/// the same row as `sums`. Identical on every instruction set.
void column_ssd_row(const ColumnSsdPairs& row, const std::int32_t* previous, std::int32_t* sums);

/// Upper limit (exclusive) of squared float differences.
inline constexpr float kFloatSquareLimit = 4194304.0F;  // 2²²

/// Same for float images. The caller scales them so that squares stay below kFloatSquareLimit. Each
/// square is rounded to the nearest integer (ties to even), so sums stay exact.
struct ColumnSsdFloat {
  const float* reference_entering = nullptr;  ///< at the first column; null with partner_entering
  const float* reference_leaving = nullptr;
  const float* partner_entering = nullptr;  ///< at candidate 0 of the first column
  const float* partner_leaving = nullptr;
  int partner_step = 1;
  int columns = 0;
  int lanes = 0;
};

void column_ssd_row(const ColumnSsdFloat& row, const std::int32_t* previous, std::int32_t* sums);

}  // namespace vantage::kernels
