#include "kernels/parabola/parabola.h"

#include <limits>

namespace vantage::kernels {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// The lowest point of the parabola through three energies, relative to the middle one.
double lowest_point(double below, double at, double above) {
  const double curvature = below - 2 * at + above;
  return curvature > 0 ? (below - above) / (2 * curvature) : 0;
}

float refined(const WinnerRow& row, const std::int32_t* cells, int x, int winner) {
  const CandidateRange candidates = row.candidates(x);
  const float disparity_px = static_cast<float>(row.geometry.disparity_min + winner);
  if (winner <= candidates.begin || winner + 1 >= candidates.end) {
    return winner == kNoWinner ? kUnknown : disparity_px;
  }
  // Sample counts may differ: sums are not comparable, means are.
  const auto energy = [&](int candidate) {
    return static_cast<double>(row.sum(cells[candidate])) / row.window_columns(x, candidate);
  };
  return static_cast<float>(row.geometry.disparity_min + winner +
                            lowest_point(energy(winner - 1), energy(winner), energy(winner + 1)));
}

}  // namespace

void integer_disparity_row(const WinnerRow& row, const std::int32_t* winners, float* disparity_px) {
  for (int j = 0; j < row.columns; ++j) {
    disparity_px[j] = winners[j] == kNoWinner
                          ? kUnknown
                          : static_cast<float>(row.geometry.disparity_min + winners[j]);
  }
}

void parabola_disparity_row(const WinnerRow& row, const std::int32_t* winners,
                            float* disparity_px) {
  const int lanes = row.geometry.lanes();
  const int last = row.geometry.count - 1;
  const auto [plain_begin, plain_end] = row.plain_columns();
  const std::int32_t* cells = row.cells;
  for (int j = 0; j < row.columns; ++j, cells += lanes) {
    const int x = row.first_column + j;
    const int winner = winners[j];
    if (x < plain_begin || x >= plain_end) {
      disparity_px[j] = refined(row, cells, x, winner);
      continue;
    }
    // All windows are whole: sums compare as well as means. At the ends of the range the missing
    // neighbour is replaced by the winner's cell and the result thrown away.
    const std::int32_t* cell = cells + winner;
    const double below = row.sum(cell[winner > 0 ? -1 : 0]);
    const double at = row.sum(cell[0]);
    const double above = row.sum(cell[winner < last ? 1 : 0]);
    const double offset = lowest_point(below, at, above);
    disparity_px[j] = static_cast<float>(row.geometry.disparity_min + winner +
                                         (winner > 0 && winner < last ? offset : 0.0));
  }
}

}  // namespace vantage::kernels
