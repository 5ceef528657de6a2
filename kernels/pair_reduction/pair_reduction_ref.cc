#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/pair_reduction/pair_reduction.h"

namespace vantage::kernels {
namespace {

// Working memory: the sums over the right image's blocks, [block · lanes + candidate].

/// How often a column of the right image is in its block.
int times_in_block(const PairRow& row, int x) {
  return row.columns % 2 != 0 && x == row.columns - 1 ? 2 : 1;
}

void add(const PairRow& row, int x, int candidate, int energy) {
  std::uint16_t& sum = row.work[x / 2 * row.lanes + candidate];
  sum = static_cast<std::uint16_t>(sum + times_in_block(row, x) * energy);
}

}  // namespace

void start_pair_row_ref(const PairRow& row) {
  constexpr int kNoCandidate = 4 * std::numeric_limits<std::uint8_t>::max();
  for (int b = 0; b < (row.columns + 1) / 2; ++b) {
    std::uint16_t* const sums = row.work + b * row.lanes;
    std::fill_n(sums, row.count, std::uint16_t{0});
    std::fill(sums + row.count, sums + row.lanes, kNoCandidate);
  }
  for (int x = 0; x < row.columns; ++x) {
    for (int k = 0; k < row.count; ++k) {
      const int partner = x + row.disparity_min + k;
      if (partner < 0 || partner >= row.columns) {
        add(row, x, k, 2 * row.without_partner);
      }
    }
  }
}

void reduce_left_part_ref(const PairRow& row, const BlockRow<std::uint8_t>& part, int first_column,
                          std::uint8_t* energies) {
  reduce_compact_energies_row_ref(part, row.weight, energies);
  for (int column = 0; column < part.columns; ++column) {
    for (int k = 0; k < row.count; ++k) {
      const int x = first_column + column - (row.disparity_min + k);
      if (x >= 0 && x < row.columns) {
        const std::ptrdiff_t cell = std::ptrdiff_t{column} * row.lanes + k;
        add(row, x, k, part.upper[cell] + part.lower[cell]);
      }
    }
  }
}

void reduce_right_row_ref(const PairRow& row, std::uint8_t* energies) {
  const long units = std::lround(row.weight * kCompactWeightUnits);
  for (int b = 0; b < (row.columns + 1) / 2; ++b) {
    const std::uint16_t* const sums = row.work + b * row.lanes;
    const int min = *std::min_element(sums, sums + row.lanes);
    std::transform(sums, sums + row.lanes, energies + b * row.lanes, [&](int sum) {
      const long above = (sum - min) * units;
      return static_cast<std::uint8_t>(
          std::min<long>((above + kCompactWeightUnits / 2) / kCompactWeightUnits, kMaxCompact));
    });
  }
}

}  // namespace vantage::kernels
