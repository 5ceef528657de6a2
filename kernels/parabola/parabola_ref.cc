#include <cmath>
#include <cstddef>
#include <limits>

#include "kernels/parabola/parabola.h"

namespace vantage::kernels {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// Vertex of the parabola through three energies, relative to the middle one.
double lowest_point(double below, double at, double above) {
  const double curvature = below - 2 * at + above;
  return curvature > 0 ? (below - above) / (2 * curvature) : 0;
}

double energy_of(const WinnerRow& row, int j, int candidate) {
  const std::ptrdiff_t lanes = row.geometry.lanes();
  const int x = row.first_column + j;
  const CandidateRange plain = row.plain_columns();
  // Sample counts may differ, so means are compared, not sums. Where all windows are whole, sums
  // are equivalent and exact.
  const int samples = x >= plain.begin && x < plain.end ? 1 : row.window_columns(x, candidate);
  return static_cast<double>(row.sum(row.cells[j * lanes + candidate])) / samples;
}

double energy_of(const CellRow& row, int j, int candidate) {
  const std::ptrdiff_t lanes = row.geometry.lanes();
  const double cell = row.cells[j * lanes + candidate];
  return row.probabilities ? -std::log(cell) : cell;
}

template <typename Row>
float refined(const Row& row, int j, int winner) {
  const CandidateRange candidates = row.candidates(row.first_column + j);
  const int disparity_px = row.geometry.disparity_min + winner;
  if (winner <= candidates.begin || winner + 1 >= candidates.end) {
    return winner == kNoWinner ? kUnknown : static_cast<float>(disparity_px);
  }
  const double below = energy_of(row, j, winner - 1);
  const double at = energy_of(row, j, winner);
  const double above = energy_of(row, j, winner + 1);
  if (std::isinf(below) || std::isinf(at) || std::isinf(above)) {
    return static_cast<float>(disparity_px);
  }
  return static_cast<float>(disparity_px + lowest_point(below, at, above));
}

template <typename Row>
void integer_disparities(const Row& row, const std::int32_t* winners, float* disparity_px) {
  for (int j = 0; j < row.columns; ++j) {
    disparity_px[j] = winners[j] == kNoWinner
                          ? kUnknown
                          : static_cast<float>(row.geometry.disparity_min + winners[j]);
  }
}

template <typename Row>
void refined_disparities(const Row& row, const std::int32_t* winners, float* disparity_px) {
  for (int j = 0; j < row.columns; ++j) {
    disparity_px[j] = refined(row, j, winners[j]);
  }
}

}  // namespace

void integer_disparity_row(const WinnerRow& row, const std::int32_t* winners, float* disparity_px) {
  integer_disparities(row, winners, disparity_px);
}

void integer_disparity_row(const CellRow& row, const std::int32_t* winners, float* disparity_px) {
  integer_disparities(row, winners, disparity_px);
}

void parabola_disparity_row_ref(const WinnerRow& row, const std::int32_t* winners,
                                float* disparity_px) {
  refined_disparities(row, winners, disparity_px);
}

void parabola_disparity_row_ref(const CellRow& row, const std::int32_t* winners,
                                float* disparity_px) {
  refined_disparities(row, winners, disparity_px);
}

}  // namespace vantage::kernels
