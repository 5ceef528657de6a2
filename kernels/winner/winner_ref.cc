#include "kernels/winner/winner.h"

namespace vantage::kernels {

void select_winners_row_ref(const WinnerRow& row, std::int32_t* winners) {
  for (int j = 0; j < row.columns; ++j) {
    const int x = row.first_column + j;
    const std::int32_t* cells = row.cells + j * row.geometry.lanes();
    const CandidateRange candidates = row.candidates(x);
    winners[j] = kNoWinner;
    std::int64_t best_sum = 0;
    std::int64_t best_count = 1;
    for (int i = candidates.begin; i < candidates.end; ++i) {
      const std::int64_t count = row.window_columns(x, i);
      const std::int64_t sum = row.sum(cells[i]);
      if (winners[j] == kNoWinner || sum * best_count < best_sum * count) {
        winners[j] = i;
        best_sum = sum;
        best_count = count;
      }
    }
  }
}

}  // namespace vantage::kernels
