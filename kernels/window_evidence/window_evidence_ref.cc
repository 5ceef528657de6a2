#include <cstddef>
#include <cstdlib>

#include "kernels/window_evidence/window_evidence.h"

namespace vantage::kernels {
namespace {

/// Distance of the codes of the reference's pixel `own` and the partner's pixel `other` of row r.
int code_distance(const WindowEvidenceRow& row, std::size_t r, std::ptrdiff_t own,
                  std::ptrdiff_t other) {
  int distance = 0;
  for (std::size_t p = 0; p < kRayCensusBytes; ++p) {
    for (int bit = 0; bit < 8; ++bit) {
      // The neighbour's number in a code.
      const auto number = [&](const WindowEvidenceRow::Codes& codes, std::ptrdiff_t at) {
        const int upper = (codes[p][at] >> bit) & 1;
        return row.thresholds == 1 ? upper
                                   : 2 * upper + ((codes[p + kRayCensusBytes][at] >> bit) & 1);
      };
      distance += std::abs(number(row.reference[r], own) - number(row.partner[r], other));
    }
  }
  return distance;
}

}  // namespace

void window_evidence_row_ref(const WindowEvidenceRow& row, const ByteByDistance& by_distance,
                             const std::array<WindowCells*, kWindows>& evidence) {
  for (int x = 0; x < row.columns; ++x) {
    for (std::size_t q = 0; q < kWindows; ++q) {
      evidence[q][x] = 0;
      if (q == 1 && row.has_second[x] == 0) {
        continue;
      }
      for (int k = 0; k < kWindowCandidates; ++k) {
        unsigned sum = 0;
        for (int pixel = row.side * x; pixel < row.side * (x + 1); ++pixel) {
          for (std::size_t r = 0; r < static_cast<std::size_t>(row.side); ++r) {
            const int other = pixel + row.direction * (row.start[q][x] + k);
            const int distance = code_distance(row, r, pixel, other);
            sum += by_distance.steps[static_cast<std::size_t>(distance)];
          }
        }
        evidence[q][x] |= static_cast<WindowCells>(sum) << (8 * k);
      }
    }
  }
}

}  // namespace vantage::kernels
