#pragma once

#include <cstdint>

namespace vantage::kernels {

// Answers about the columns of a row as bits: that of column x is bit x % 64 of word x / 64. Bits
// behind the width are 0.

/// How many words the bits of a row take.
constexpr int row_words(int width) { return (width + 63) / 64; }

/// Bit x: |a[x] − b[x]| ≤ `limit`; never where one of them is NaN. `width` values each, ≥ 0. Equal
/// to the reference on every instruction set.
void near_bits_row(const float* a, const float* b, float limit, int width, std::uint64_t* bits);
void near_bits_row_ref(const float* a, const float* b, float limit, int width, std::uint64_t* bits);

/// Bit x: values[x] is 0. As above.
void zero_bits_row(const std::uint8_t* values, int width, std::uint64_t* bits);
void zero_bits_row_ref(const std::uint8_t* values, int width, std::uint64_t* bits);

}  // namespace vantage::kernels
