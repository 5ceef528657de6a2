#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <span>

#include "kernels/max_product_step/max_product_step.h"

namespace vantage::kernels {
namespace {

// ES of candidate i in a two-dimensional search.
FixedEnergy smoothed_in_plane(const MaxProductRow& row, std::span<const FixedEnergy> energies,
                              int i) {
  const CandidatePlane& plane = row.plane;
  const auto rise = [&row](int offset) { return offset == 0 ? 0 : row.prior.rises[offset - 1]; };
  int smoothed = row.prior.ceiling;
  for (int j = 0; i < plane.count() && j < plane.count(); ++j) {
    const int across = std::abs(j % plane.row_candidates - i % plane.row_candidates);
    const int down = std::abs(j / plane.row_candidates - i / plane.row_candidates);
    if (across <= row.prior.radius && down <= row.prior.radius) {
      smoothed =
          std::min(smoothed, energies[static_cast<std::size_t>(j)] + rise(across) + rise(down));
    }
  }
  return static_cast<FixedEnergy>(smoothed);
}

// Subtracts the minimum of the column in work memory and stores the row's kind of result.
void finish_column(const MaxProductRow& row, FixedEnergy* output) {
  const std::span<FixedEnergy> energies(row.work, static_cast<std::size_t>(row.star.lanes));
  const FixedEnergy min = *std::min_element(energies.begin(), energies.end());
  for (FixedEnergy& energy : energies) {
    energy = static_cast<FixedEnergy>(energy - min);
  }
  if (!row.smooths) {
    std::copy(energies.begin(), energies.end(), output);
    return;
  }
  if (row.plane.is_given()) {
    for (int i = 0; i < row.star.lanes; ++i) {
      output[i] = smoothed_in_plane(row, energies, i);
    }
    return;
  }
  const int whole = row.star.lanes;
  const std::span<const int> ends =
      row.segment_ends.empty() ? std::span<const int>(&whole, 1) : row.segment_ends;
  int begin = 0;
  for (const int end : ends) {
    for (int i = begin; i < end; ++i) {
      FixedEnergy smoothed = std::min(energies[static_cast<std::size_t>(i)], row.prior.ceiling);
      for (int k = 1; k <= row.prior.radius; ++k) {
        for (const int beside : {i - k, i + k}) {
          if (beside >= begin && beside < end) {
            smoothed = std::min(smoothed, saturated_sum(energies[static_cast<std::size_t>(beside)],
                                                        row.prior.rises[k - 1]));
          }
        }
      }
      output[i] = smoothed;
    }
    begin = end;
  }
}

}  // namespace

void max_product_start_row_ref(const MaxProductRow& row) {
  for (int x = 0; x < row.star.columns; ++x) {
    std::copy_n(row.star.source + x * row.source_pitch, row.star.lanes, row.work);
    finish_column(row, row.output + x * row.output_pitch);
  }
}

void max_product_row_ref(const MaxProductRow& row) {
  const CellStarRow<FixedEnergy>& star = row.star;
  for (int x = 0; x < star.columns; ++x) {
    const EnergyStarWeights& weights = row.weights;
    const bool weighs = weights.are_given();
    const FixedWeight left = weighs ? weights.beside[x] : row.mu;
    const FixedWeight right = weighs ? weights.beside[x + 1] : row.mu;
    const FixedWeight up = weighs ? weights.above[x] : row.mu;
    const FixedWeight down = weighs ? weights.below[x] : row.mu;
    for (int i = 0; i < star.lanes; ++i) {
      const int neighbours = weighted(star.left_of(x)[i], left) +
                             weighted(star.right_of(x)[i], right) +
                             weighted(star.up[x * star.up_pitch + i], up) +
                             weighted(star.down[x * star.down_pitch + i], down) +
                             weighted(star.centre[x * star.pitch + i], row.mu);
      row.work[i] = saturated_sum(static_cast<FixedEnergy>(neighbours),
                                  star.source[x * row.source_pitch + i]);
    }
    finish_column(row, row.output + x * row.output_pitch);
  }
}

}  // namespace vantage::kernels
