#pragma once

#include <cstdint>

#include "kernels/block_row.h"
#include "kernels/candidates.h"

namespace vantage::kernels {

// Likelihoods and probabilities in one byte each, as logarithms: Bayesian diffusion keeps coarse
// levels in this form. All but the smallest energy differences survive: half a step of an energy is
// 6 % of a likelihood. All functions are identical on every instruction set.

/// Energies −ln p0 above their column's minimum, in steps of 1/8; 255 stands for all from 31.9.
inline constexpr float kEnergyStep = 1.0F / 8;
/// Probabilities as −log₂ p in steps of 1/8; 255 stands for all up to 2^−31.9.
inline constexpr float kProbabilityExponentStep = 1.0F / 8;
inline constexpr int kMaxCompact = 255;
/// Probabilities are clamped to at least 2^−32.
inline constexpr float kMinCompactProbability = 2.3283064365386963e-10F;
/// Likelihoods are clamped to at least 2^−31: the product of four is still a normal float.
inline constexpr float kMinReducedLikelihood = 4.656612873077393e-10F;

/// Reduces blocks of four columns: the block's energy is `weight` (in (0, 1]) times the sum of its
/// four columns' energies. Cells are likelihoods in [0, 1], up to a factor per column; lanes that
/// are not candidates hold 0. `work`: row.lanes floats. Output lanes that are not candidates are at
/// least as large as any candidate.
void reduce_likelihoods_row(const BlockRow<float>& row, float weight, float* work,
                            std::uint8_t* energies);

/// Weights of compact energies are multiples of 1/this.
inline constexpr int kCompactWeightUnits = 16384;

/// Same for compact energies; halves of a step round up. `work`: row.lanes numbers. Non-candidate
/// lanes at least as large as the last candidate, before and after.
void reduce_compact_energies_row(const BlockRow<std::uint8_t>& row, float weight,
                                 std::uint16_t* work, std::uint8_t* energies);

/// Lets the surface of a column slant: every energy becomes the smallest of itself and of those of
/// the adjacent candidates plus `penalty`. Of all `columns` · `lanes` cells, `lanes` per column, a
/// multiple of kLaneMultiple. Lanes that are not candidates must be at least as large as the last
/// candidate, and remain so.
void allow_slant_row(std::uint8_t* energies, int columns, int lanes, std::uint8_t penalty);

/// Compact cells, `lanes` per column.
struct CompactRow {
  const std::uint8_t* cells = nullptr;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  int count = 0;  ///< candidates: lanes [0, count)
};

/// Likelihoods exp(−energy); 0 in lanes that are not candidates.
void likelihoods_of_compact_row(const CompactRow& row, float* likelihoods);
/// Same for probabilities; they no longer sum to 1.
void probabilities_of_compact_row(const CompactRow& row, float* probabilities);

/// Probabilities in [0, 1]. cells: a multiple of kLaneMultiple.
void compact_probabilities_row(const float* probabilities, int cells, std::uint8_t* compact);

}  // namespace vantage::kernels
