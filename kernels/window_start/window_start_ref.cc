#include <algorithm>

#include "kernels/window_start/window_start.h"

namespace vantage::kernels {

void second_winners_row_ref(const std::array<const std::int16_t*, 3>& winners, int columns,
                            std::int16_t* second) {
  for (int x = 0; x < columns; ++x) {
    const int own = winners[1][x];
    int min = own;
    int max = own;
    for (const std::int16_t* const row : winners) {
      for (int at = x - 1; at <= x + 1; ++at) {
        min = std::min<int>(min, row[at]);
        max = std::max<int>(max, row[at]);
      }
    }
    const int other = own - min >= kOtherSurface   ? min
                      : max - own >= kOtherSurface ? max
                                                   : kNoSecondWinner;
    second[x] = static_cast<std::int16_t>(other);
  }
}

void window_start_row_ref(const CoarseEnergies& coarse, WindowCells* support) {
  for (int x = 0; x < coarse.columns; ++x) {
    support[x] = 0;
    for (int k = 0; k < kWindowCandidates; ++k) {
      const int at = coarse.spacing == 1 ? 2 * k : k + coarse.offset_bits[x] / 8;
      const int energy = window_cell(coarse.energies[x], at / 2);
      const int next = at % 2 == 0 ? energy : window_cell(coarse.energies[x], at / 2 + 1);
      const int steps = ((energy + next + 1) / 2 * coarse.steps) >> 8;
      support[x] |= static_cast<WindowCells>(std::max(0, coarse.ceiling - steps)) << (8 * k);
    }
    support[x] &= coarse.lanes;
  }
}

}  // namespace vantage::kernels
