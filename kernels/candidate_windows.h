#pragma once

#include <cstdint>

namespace vantage::kernels {

// Windows: a few consecutive candidates around a guess, in place of all candidates. A column has
// one window, or two where surfaces meet; they may overlap.

/// Candidates of a window.
inline constexpr int kWindowCandidates = 8;
/// Windows of a column.
inline constexpr int kWindows = 2;
/// Rows of windows are readable this many columns before the first and after the last one. Kernels
/// may write as many after the last one, unless they say more.
inline constexpr int kWindowMargin = 16;

/// One byte for each candidate of a window, the first one in the lowest byte. The bytes are
/// log-likelihoods in steps, above the least that counts: 0 where nothing is known, in windows that
/// do not exist, and for lanes that are not candidates.
using WindowCells = std::uint64_t;

/// Byte k of `cells`.
constexpr int window_cell(WindowCells cells, int k) {
  return static_cast<int>((cells >> (8 * k)) & 0xFFU);
}

}  // namespace vantage::kernels
