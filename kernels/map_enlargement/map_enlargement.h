#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Disparities of neighbours that differ by at most this are of one surface.
inline constexpr float kEnlargedSurfaceStepPx = 1;
/// A pixel takes the disparity of another surface if it is more similar to that column by more than
/// this many grey levels.
inline constexpr int kEnlargedPreference = 6;

/// A row of a map of half the size, to be enlarged to one of the two rows that it covers.
struct EnlargedRow {
  const float* own_px = nullptr;     ///< (width + 1)/2 disparities, NaN = unknown
  const float* beside_px = nullptr;  ///< the half-size row on the other side of the enlarged one
  const std::uint8_t* own_intensities = nullptr;  ///< of the half-size image
  const std::uint8_t* beside_intensities = nullptr;
  const std::uint8_t* intensities = nullptr;  ///< of the enlarged row's pixels
  int width = 0;                              ///< pixels of the enlarged row
};

/// A pixel lies a quarter of a column from the centre of its own column, towards a neighbour in the
/// row and one in the other row. Its disparity is that of its column, plus a quarter of the
/// difference to each of the two, if that is at most kEnlargedSurfaceStepPx. If those two columns
/// or the one diagonally between them are of another surface, it takes the disparity of the one
/// whose intensity is nearest to its own, if that is nearer than its own column's by more than
/// kEnlargedPreference; of equal ones the first of: beside, other row, diagonal. Columns outside
/// the map repeat the nearest one. Identical on every instruction set.
void enlarge_map_row(const EnlargedRow& row, float* disparity_px);

/// Scalar reference for pixels [begin, end).
void enlarge_map_row_ref(const EnlargedRow& row, int begin, int end, float* disparity_px);

}  // namespace vantage::kernels
