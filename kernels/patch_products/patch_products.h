#pragma once

#include <cstddef>

namespace vantage::kernels {

/// A patch, and rows to compare it with.
struct PatchProducts {
  const float* patch = nullptr;  ///< [row][column]
  int rows = 0;                  ///< ≥ 1
  int columns = 0;               ///< ≥ 1
  const float* other = nullptr;  ///< where the patch lies at the first place
  std::ptrdiff_t stride = 0;     ///< values between rows of `other`
};

/// Places that are computed at once.
inline constexpr int kPatchPlaces = 16;

/// sums[c] = Σ patch(row, column) · other(row, c + column), in the order of rows, c in [0, count):
/// the numerators of correlations along a row. `count` is rounded up to a multiple of kPatchPlaces:
/// `sums` has room for these, and `other` is read for them. Identical on every instruction set.
void patch_products(const PatchProducts& task, int count, float* sums);

}  // namespace vantage::kernels
