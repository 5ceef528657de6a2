#include <bit>
#include <cstddef>

#include "kernels/window_evidence/window_evidence.h"

namespace vantage::kernels {

void window_evidence_row_ref(const WindowEvidenceRow& row, const EvidenceByDistance& by_distance,
                             const std::array<WindowCells*, kWindows>& evidence) {
  for (int x = 0; x < row.columns; ++x) {
    for (std::size_t q = 0; q < kWindows; ++q) {
      evidence[q][x] = 0;
      if (q == 1 && row.has_second[x] == 0) {
        continue;
      }
      for (int k = 0; k < kWindowCandidates; ++k) {
        unsigned sum = 0;
        for (int pixel = 2 * x; pixel < 2 * x + 2; ++pixel) {
          for (std::size_t r = 0; r < 2; ++r) {
            unsigned distance = 0;
            for (std::size_t p = 0; p < kRayCensusBytes; ++p) {
              const int own = row.reference[r][p][pixel];
              const int other = row.partner[r][p][pixel + row.direction * (row.start[q][x] + k)];
              distance += static_cast<unsigned>(std::popcount(static_cast<unsigned>(own ^ other)));
            }
            sum += by_distance.steps[distance];
          }
        }
        evidence[q][x] |= static_cast<WindowCells>(sum) << (8 * k);
      }
    }
  }
}

}  // namespace vantage::kernels
