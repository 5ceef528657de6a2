#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdlib>

#include "kernels/combined_cost/combined_cost.h"

namespace vantage::kernels {
namespace {

/// Distance of `value` from [low, high]; 0 inside.
int distance(int value, int low, int high) { return std::max({value - high, low - value, 0}); }

int step_of(int residual, const CombinedTerm& term) {
  const std::uint32_t product = static_cast<std::uint32_t>(residual) * term.multiplier;
  return static_cast<int>(std::min<std::uint32_t>(product >> 16U, kResidualSteps - 1));
}

int grey_step(const FixedIntensityPairs& row, int j, int k, const CombinedTerm& term) {
  int sum = 0;
  for (int c = 0; c < row.channels; ++c) {
    const auto& [reference, partner] = row.channel[static_cast<std::size_t>(c)];
    sum += std::min(distance(reference[0][j], partner[1][k], partner[2][k]),
                    distance(partner[0][k], reference[1][j], reference[2][j]));
  }
  return step_of(sum, term);
}

int census_step(const CensusPairs& row, int j, int k) {
  const auto& [reference, partner] = row.channel[0];
  return std::popcount(reference[0][j] ^ partner[0][k]) +
         std::popcount(reference[1][j] ^ partner[1][k]);
}

int gradient_step(const FixedGradientPairs& row, int j, int k, const CombinedTerm& term) {
  const auto& [reference, partner] = row.channel[0];
  return step_of(
      std::abs(reference[0][j] - partner[0][k]) + std::abs(reference[1][j] - partner[1][k]), term);
}

std::uint32_t value_of(const CombinedTerm& term, int step) {
  const auto at = static_cast<std::size_t>(step);
  return term.table.low[at] | static_cast<std::uint32_t>(term.table.high[at]) << 8U;
}

}  // namespace

void combined_row_ref(const CombinedRow& row, const CombinedModel& model, CombinedCells meaning,
                      float* cells) {
  const FixedIntensityPairs& shape = row.levels;
  for (int j = 0; j < shape.columns; ++j) {
    for (int i = 0; i < shape.lanes; ++i) {
      const int k = j * shape.partner_step + i;
      std::uint32_t energy = 0;
      float likelihood = 1;
      const auto add = [&](std::uint32_t value) {
        energy += value;
        likelihood *= std::bit_cast<float>(value << 16U);
      };
      add(value_of(model.grey, grey_step(row.levels, j, k, model.grey)));
      if (model.has_census) {
        add(value_of(model.census, census_step(row.codes, j, k)));
      }
      if (model.has_gradient) {
        add(value_of(model.gradient, gradient_step(row.gradients, j, k, model.gradient)));
      }
      float& cell = cells[j * shape.lanes + i];
      if (meaning == CombinedCells::kEnergy) {
        cell = static_cast<float>(energy) * (1.0F / kEnergyUnitsPerNat);
      } else {
        cell = i < shape.count ? likelihood : 0.0F;
      }
    }
  }
}

}  // namespace vantage::kernels
