#pragma once

#include <cstdint>

namespace vantage::kernels {

// Per-column predicates of a row as bits: column x is bit x % 64 of word x / 64. Bits ≥ width are
// 0.

/// Number of words for a row.
constexpr int row_words(int width) { return (width + 63) / 64; }

/// Bit x: |a[x] − b[x]| ≤ `limit`; false if either is NaN. `width` values each, ≥ 0. Equal to the
/// reference on every instruction set.
void near_bits_row(const float* a, const float* b, float limit, int width, std::uint64_t* bits);

/// Bit x: values[x] == 0. As above.
void zero_bits_row(const std::uint8_t* values, int width, std::uint64_t* bits);

}  // namespace vantage::kernels
