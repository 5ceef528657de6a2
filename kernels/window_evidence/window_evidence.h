#pragma once

#include <array>
#include <cstdint>

#include "kernels/candidate_windows.h"
#include "kernels/census/census.h"

namespace vantage::kernels {

// Evidence of windows: a column stands for 2×2 pixels, whose ray census codes (one threshold) are
// compared with their partners' at a few candidates.

/// Log-likelihood by number of differing neighbours, above the least, in steps of a cell. At most
/// kMaxPixelEvidence, so that four of them fit a cell.
struct EvidenceByDistance {
  alignas(16) std::array<std::uint8_t, 32> steps{};  ///< entries after the last distance are 0
};
inline constexpr int kMaxPixelEvidence = 63;

struct WindowEvidenceRow {
  using Codes = std::array<const std::uint8_t*, kRayCensusBytes>;
  /// The reference's upper and lower row of pixels, at the left pixel of the first column.
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
  /// The second pixel of the last column may lie outside the image: reference rows must be readable
  /// there.
  int columns = 0;
};

/// The sum over the four pixels. Evidence of second windows that do not exist is 0.
void window_evidence_row(const WindowEvidenceRow& row, const EvidenceByDistance& by_distance,
                         const std::array<WindowCells*, kWindows>& evidence);
void window_evidence_row_ref(const WindowEvidenceRow& row, const EvidenceByDistance& by_distance,
                             const std::array<WindowCells*, kWindows>& evidence);

}  // namespace vantage::kernels
