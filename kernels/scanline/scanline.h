#pragma once

#include <cstdint>

#include "kernels/cell_winner/cell_winner.h"

namespace vantage::kernels {

/// Cost of a change of disparity between neighbouring columns (EQUATIONS §3.15): truncated linear,
/// V(k) = min(penalty · |k|, limit) for a change of k candidates. penalty ≥ limit: the same for
/// all changes.
struct JumpCost {
  float penalty = 0;  ///< ≥ 0, per candidate
  float limit = 0;    ///< ≥ 0; may be infinite

  [[nodiscard]] float of(int change) const {
    const float linear = penalty * static_cast<float>(change < 0 ? -change : change);
    return linear < limit ? linear : limit;
  }
  /// The largest change, at most count − 1, that costs less than the limit.
  [[nodiscard]] int linear_changes(int count) const;
  /// Passes that spread path energies over changes of 1, 2, 4, … candidates, until they reach
  /// linear_changes().
  [[nodiscard]] int passes(int count) const;
};

/// Working memory of scanline_winners_row(), 64-byte aligned.
struct ScanlineWork {
  float* paths = nullptr;   ///< geometry.lanes() per column
  float* minima = nullptr;  ///< one per column
  float* spread = nullptr;  ///< scanline_spread_floats()
};

/// Floats of ScanlineWork::spread.
int scanline_spread_floats(const CandidateGeometry& geometry, const JumpCost& jump);

/// winners[j]: the disparities of one row that minimise Σ E(x, d(x)) + Σ V(d(x) − d(x−1)), by
/// dynamic programming from left to right; kNoWinner where no candidate counts, where a new path
/// starts. row.cells are energies (`row.probabilities` is ignored), all columns of the image's row.
/// Of equally good predecessors the one with the smaller change counts, then the smaller candidate;
/// of equally good ends the smaller candidate. O(D log D) operations per column. Identical on every
/// instruction set.
void scanline_winners_row(const CellRow& row, const JumpCost& jump, const ScanlineWork& work,
                          std::int32_t* winners);

/// Second half of both: the best path through path energies.
void trace_scanline_row(const CellRow& row, const JumpCost& jump, const ScanlineWork& work,
                        std::int32_t* winners);

}  // namespace vantage::kernels
