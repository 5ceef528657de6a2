#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "kernels/block_row.h"
#include "kernels/candidates.h"

namespace vantage::kernels {

// Energies as half floats (sign, 5-bit exponent, 10-bit significand): methods that store energies
// keep coarse levels in this form. Winners are small differences between small energies, which half
// floats resolve to 1/2048 of their size. 16-bit formats with a shorter significand, or with equal
// steps over the whole range of a cost, do not. The conversion uses the same steps on every
// instruction set, so all results are identical.

/// Larger magnitudes would be infinite as half floats; they are clamped to this.
inline constexpr float kLargestHalf = 65504.0F;
/// The exponent biases of floats and half floats differ by 112.
inline constexpr float kHalfToFloat = 0x1p112F;
inline constexpr float kFloatToHalf = 0x1p-112F;
/// Significand bits of a float minus those of a half float.
inline constexpr int kHalfShift = 13;

/// Half float nearest to `value`, ties to even. Below 2^−14, where scaled floats are denormal,
/// accurate to half a step plus 2^−13 of a step.
inline std::uint16_t to_half(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const float magnitude = std::min(std::bit_cast<float>(bits & 0x7FFFFFFFU), kLargestHalf);
  const auto small = std::bit_cast<std::uint32_t>(magnitude * kFloatToHalf);
  const std::uint32_t odd = (small >> kHalfShift) & 1U;
  const std::uint32_t rounded = (small + 0xFFFU + odd) >> kHalfShift;
  return static_cast<std::uint16_t>(rounded | ((bits >> 16U) & 0x8000U));
}
inline float of_half(std::uint16_t half) {
  const std::uint32_t magnitude = (half & 0x7FFFU) << kHalfShift;
  const float value = std::bit_cast<float>(magnitude) * kHalfToFloat;
  return (half & 0x8000U) != 0 ? -value : value;
}

/// halves = scale · energies. cells: a multiple of kLaneMultiple.
void half_energies_row(const float* energies, int cells, float scale, std::uint16_t* halves);

/// energies = unit · halves.
void energies_of_half_row(const std::uint16_t* halves, int cells, float unit, float* energies);

/// Mean of the four columns of each block, times `scale`, as half floats.
void reduce_energies_row(const BlockRow<float>& row, float scale, std::uint16_t* halves);
void reduce_half_energies_row(const BlockRow<std::uint16_t>& row, std::uint16_t* halves);

/// Columns of a level and the columns of the next coarser level that cover them: column x lies in
/// coarser column x / 2.
struct CoarserRow {
  const std::uint16_t* coarser = nullptr;  ///< column first_column / 2
  int first_column = 0;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  float unit = 1;
};

/// output = unit · coarser.
void energies_from_coarser_row(const CoarserRow& row, float* output);
/// output = ½ (own + unit · coarser).
void energies_with_coarser_row(const CoarserRow& row, const float* own, float* output);

}  // namespace vantage::kernels
