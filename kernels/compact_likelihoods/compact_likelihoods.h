#pragma once

#include <cstdint>

#include "kernels/block_row.h"
#include "kernels/candidates.h"

namespace vantage::kernels {

// Likelihoods and probabilities in a byte each, as logarithms: what Bayesian diffusion keeps of
// coarse levels. All but the smallest differences between energies survive: half a step of an
// energy is 6 % of a likelihood. All identical on every instruction set.

/// Energies −ln p0, above the least of their column, in steps of 1/8; 255 stands for all from 31.9.
inline constexpr float kEnergyStep = 1.0F / 8;
/// Probabilities as −log₂ p in steps of 1/8; 255 stands for all up to 2^−31.9.
inline constexpr float kProbabilityExponentStep = 1.0F / 8;
inline constexpr int kMostCompact = 255;
/// Probabilities below 2^−32 count as this.
inline constexpr float kLeastCompactProbability = 2.3283064365386963e-10F;
/// Likelihoods below 2^−31 count as this: the product of four stays a normal number.
inline constexpr float kLeastReducedLikelihood = 4.656612873077393e-10F;

/// The energy of a block is `weight` (above 0, at most 1) times the sum of those of its four
/// columns. Cells are likelihoods in [0, 1], up to a factor per column; those of lanes that are no
/// candidates are 0. `work`: row.lanes floats. Energies of lanes that are no candidates are not
/// less than those of any candidate.
void reduce_likelihoods_row(const BlockRow<float>& row, float weight, float* work,
                            std::uint8_t* energies);
void reduce_likelihoods_row_ref(const BlockRow<float>& row, float weight, std::uint8_t* energies);

/// Weights of compact energies are multiples of 1/this.
inline constexpr int kCompactWeightUnits = 16384;

/// The same of compact energies, halves of a step being rounded up. `work`: row.lanes numbers.
/// Lanes that are no candidates as above.
void reduce_compact_energies_row(const BlockRow<std::uint8_t>& row, float weight,
                                 std::uint16_t* work, std::uint8_t* energies);
void reduce_compact_energies_row_ref(const BlockRow<std::uint8_t>& row, float weight,
                                     std::uint8_t* energies);

/// Compact cells, `lanes` a column.
struct CompactRow {
  const std::uint8_t* cells = nullptr;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  int count = 0;  ///< candidates: lanes [0, count)
};

/// Likelihoods exp(−energy), 0 in lanes that are no candidates.
void likelihoods_of_compact_row(const CompactRow& row, float* likelihoods);
void likelihoods_of_compact_row_ref(const CompactRow& row, float* likelihoods);
/// The same of probabilities; they no longer sum to 1.
void probabilities_of_compact_row(const CompactRow& row, float* probabilities);
void probabilities_of_compact_row_ref(const CompactRow& row, float* probabilities);

/// Probabilities in [0, 1]. cells: a multiple of kLaneMultiple.
void compact_probabilities_row(const float* probabilities, int cells, std::uint8_t* compact);
void compact_probabilities_row_ref(const float* probabilities, int cells, std::uint8_t* compact);

}  // namespace vantage::kernels
