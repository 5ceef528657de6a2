#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernels/cells/exp_log.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

namespace vantage::kernels {
namespace {

std::uint8_t to_byte(float steps) {
  return static_cast<std::uint8_t>(
      std::min(std::nearbyint(steps), static_cast<float>(kMostCompact)));
}

void powers_row(const CompactRow& row, float exponent_of_step, float* output) {
  for (int k = 0; k < row.columns * row.lanes; ++k) {
    output[k] = k % row.lanes < row.count
                    ? exp2_of_negative(static_cast<float>(row.cells[k]) * exponent_of_step)
                    : 0;
  }
}

}  // namespace

void reduce_likelihoods_row_ref(const BlockRow<float>& row, float weight, std::uint8_t* energies) {
  const auto likelihood = [&](const float* cells, std::ptrdiff_t column, int lane) {
    return std::max(cells[column + lane], kLeastReducedLikelihood);
  };
  for (int b = 0; b < row.blocks(); ++b) {
    std::vector<float> logs;
    for (int lane = 0; lane < row.lanes; ++lane) {
      const float upper =
          likelihood(row.upper, row.left(b), lane) * likelihood(row.upper, row.right(b), lane);
      const float lower =
          likelihood(row.lower, row.left(b), lane) * likelihood(row.lower, row.right(b), lane);
      logs.push_back(log_of_normal(upper * lower));
    }
    const float most = *std::max_element(logs.begin(), logs.end());
    for (int lane = 0; lane < row.lanes; ++lane) {
      energies[b * row.lanes + lane] =
          to_byte((most - logs[static_cast<std::size_t>(lane)]) * (weight / kEnergyStep));
    }
  }
}

void reduce_compact_energies_row_ref(const BlockRow<std::uint8_t>& row, float weight,
                                     std::uint8_t* energies) {
  const long units = std::lround(weight * kCompactWeightUnits);
  for (int b = 0; b < row.blocks(); ++b) {
    std::vector<int> sums;
    for (int lane = 0; lane < row.lanes; ++lane) {
      sums.push_back(row.upper[row.left(b) + lane] + row.upper[row.right(b) + lane] +
                     row.lower[row.left(b) + lane] + row.lower[row.right(b) + lane]);
    }
    const int least = *std::min_element(sums.begin(), sums.end());
    for (int lane = 0; lane < row.lanes; ++lane) {
      const long above = (sums[static_cast<std::size_t>(lane)] - least) * units;
      energies[b * row.lanes + lane] = static_cast<std::uint8_t>(
          std::min<long>((above + kCompactWeightUnits / 2) / kCompactWeightUnits, kMostCompact));
    }
  }
}

void likelihoods_of_compact_row_ref(const CompactRow& row, float* likelihoods) {
  powers_row(row, -kEnergyStep * kLog2E, likelihoods);
}

void probabilities_of_compact_row_ref(const CompactRow& row, float* probabilities) {
  powers_row(row, -kProbabilityExponentStep, probabilities);
}

void compact_probabilities_row_ref(const float* probabilities, int cells, std::uint8_t* compact) {
  const float steps = -kLog2E / kProbabilityExponentStep;
  for (int k = 0; k < cells; ++k) {
    const float log = log_of_normal(std::max(probabilities[k], kLeastCompactProbability));
    compact[k] = to_byte(std::max(log * steps, 0.0F));
  }
}

}  // namespace vantage::kernels
