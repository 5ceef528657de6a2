#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/cells/exp_log.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

namespace vantage::kernels {
namespace {

std::uint8_t to_byte(float steps) {
  return static_cast<std::uint8_t>(
      std::min(std::nearbyint(steps), static_cast<float>(kMaxCompact)));
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
  const auto likelihood = [](const float* cells, std::ptrdiff_t cell) {
    return std::max(cells[cell], kMinReducedLikelihood);
  };
  const auto log = [&](int block, int lane) {
    const std::ptrdiff_t left = row.left(block) + lane;
    const std::ptrdiff_t right = row.right(block) + lane;
    const float upper = likelihood(row.upper, left) * likelihood(row.upper, right);
    const float lower = likelihood(row.lower, left) * likelihood(row.lower, right);
    return log_of_normal(upper * lower);
  };
  for (int b = 0; b < row.blocks(); ++b) {
    float max = log(b, 0);
    for (int lane = 1; lane < row.lanes; ++lane) {
      max = std::max(max, log(b, lane));
    }
    for (int lane = 0; lane < row.lanes; ++lane) {
      energies[b * row.lanes + lane] = to_byte((max - log(b, lane)) * (weight / kEnergyStep));
    }
  }
}

void reduce_compact_energies_row_ref(const BlockRow<std::uint8_t>& row, float weight,
                                     std::uint8_t* energies) {
  const long units = std::lround(weight * kCompactWeightUnits);
  const auto sum = [&](int block, int lane) {
    const std::ptrdiff_t left = row.left(block) + lane;
    const std::ptrdiff_t right = row.right(block) + lane;
    return row.upper[left] + row.upper[right] + row.lower[left] + row.lower[right];
  };
  for (int b = 0; b < row.blocks(); ++b) {
    int min = sum(b, 0);
    for (int lane = 1; lane < row.lanes; ++lane) {
      min = std::min(min, sum(b, lane));
    }
    for (int lane = 0; lane < row.lanes; ++lane) {
      const long above = (sum(b, lane) - min) * units;
      energies[b * row.lanes + lane] = static_cast<std::uint8_t>(
          std::min<long>((above + kCompactWeightUnits / 2) / kCompactWeightUnits, kMaxCompact));
    }
  }
}

void allow_slant_row_ref(std::uint8_t* energies, int columns, int lanes, std::uint8_t penalty) {
  for (int x = 0; x < columns; ++x, energies += lanes) {
    int before = kMaxCompact;
    for (int lane = 0; lane < lanes; ++lane) {
      const int own = energies[lane];
      const int after = lane + 1 < lanes ? energies[lane + 1] : kMaxCompact;
      energies[lane] =
          static_cast<std::uint8_t>(std::min(own, std::min(before, after) + int{penalty}));
      before = own;
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
    const float log = log_of_normal(std::max(probabilities[k], kMinCompactProbability));
    compact[k] = to_byte(std::max(log * steps, 0.0F));
  }
}

}  // namespace vantage::kernels
