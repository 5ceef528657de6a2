#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "kernels/block_row.h"
#include "kernels/candidates.h"

namespace vantage::kernels {

// Energies as half floats (sign, 5 bits of exponent, 10 of significand): what methods that keep
// energies keep of coarse levels. Winners are small differences between small energies, which half
// floats resolve to 1/2048 of their size; numbers of as many bits with fewer for the significand
// or with equal steps over the whole range of a cost do not. Converted in steps that are the same
// on every instruction set, so all results are identical.

/// Half floats of larger magnitude would be infinite: larger energies count as this.
inline constexpr float kLargestHalf = 65504.0F;
/// The exponents of floats and half floats are 112 apart.
inline constexpr float kHalfToFloat = 0x1p112F;
inline constexpr float kFloatToHalf = 0x1p-112F;
/// Bits that the significand of a half float has less.
inline constexpr int kHalfShift = 13;

/// The half float nearest to `value`, the even one of two; below 2^−14, where floats of this scale
/// lose bits themselves, to half a step and a 2^−13th.
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
void half_energies_row_ref(const float* energies, int cells, float scale, std::uint16_t* halves);

/// energies = unit · halves.
void energies_of_half_row(const std::uint16_t* halves, int cells, float unit, float* energies);
void energies_of_half_row_ref(const std::uint16_t* halves, int cells, float unit, float* energies);

/// The mean of the four columns of each block, times `scale`, as half floats.
void reduce_energies_row(const BlockRow<float>& row, float scale, std::uint16_t* halves);
void reduce_energies_row_ref(const BlockRow<float>& row, float scale, std::uint16_t* halves);
void reduce_half_energies_row(const BlockRow<std::uint16_t>& row, std::uint16_t* halves);
void reduce_half_energies_row_ref(const BlockRow<std::uint16_t>& row, std::uint16_t* halves);

/// Columns of a level, over columns of the next coarser one: column x lies in column x / 2 of that.
struct CoarserRow {
  const std::uint16_t* coarser = nullptr;  ///< column first_column / 2
  int first_column = 0;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  float unit = 1;
};

/// output = unit · coarser.
void energies_from_coarser_row(const CoarserRow& row, float* output);
void energies_from_coarser_row_ref(const CoarserRow& row, float* output);
/// output = ½ (own + unit · coarser).
void energies_with_coarser_row(const CoarserRow& row, const float* own, float* output);
void energies_with_coarser_row_ref(const CoarserRow& row, const float* own, float* output);

}  // namespace vantage::kernels
