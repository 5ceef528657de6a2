#pragma once

#include <array>
#include <cstdint>

#include "kernels/candidate_windows.h"
#include "kernels/census/census.h"
#include "kernels/ray_census/ray_census.h"

namespace vantage::kernels {

// Evidence of windows: a column stands for one pixel or 2×2, whose ray census codes are compared
// with their partners' at a few candidates.

/// Largest evidence of one of 2×2 pixels, so that four of them fit a cell.
inline constexpr int kMaxPixelEvidence = 63;

struct WindowEvidenceRow {
  using Codes = std::array<const std::uint8_t*, kMaxRayCensusBytes>;
  /// Pixels of a column along one direction, 1 or 2.
  int side = 2;
  int thresholds = 1;  ///< of the codes, 1 or 3
  /// The reference's rows of pixels, `side` of them, at the first (left) pixel of the first column.
  std::array<Codes, 2> reference;
  /// The partner's rows, at the partner of that pixel at candidate 0. The partner of the i-th
  /// pixel at candidate c is at i + direction · c; rows are readable for 8 columns beyond the
  /// partners of all candidates of the windows, on both sides.
  std::array<Codes, 2> partner;
  int direction = 1;  ///< +1 or −1
  /// First candidates, per column and window. Columns 2i and 2i + 1, which one coarser column
  /// covers, have the same windows.
  std::array<const std::int16_t*, kWindows> start = {};
  const std::uint8_t* has_second = nullptr;  ///< ≠ 0 for columns with a second window
  /// Reference rows must be readable for two pixels of the last column and of the one after it,
  /// which may lie outside the image.
  int columns = 0;
};

/// by_distance: log-likelihood by distance of codes, above the least, in steps of a cell; with 2×2
/// pixels at most kMaxPixelEvidence. Writes its sum over the pixels of each column. Evidence of
/// second windows that do not exist is 0.
void window_evidence_row(const WindowEvidenceRow& row, const ByteByDistance& by_distance,
                         const std::array<WindowCells*, kWindows>& evidence);
void window_evidence_row_ref(const WindowEvidenceRow& row, const ByteByDistance& by_distance,
                             const std::array<WindowCells*, kWindows>& evidence);

}  // namespace vantage::kernels
