#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/block_row.h"
#include "kernels/candidates.h"

namespace vantage::kernels {

// Byte energies of both images of a pair, reduced as reduce_compact_energies_row() does, from those
// of the left image alone: the energy of disparity d at column x of the right image is that of d at
// column x + d of the left one. One row of blocks is made by start_pair_row(), reduce_left_part()
// of consecutive parts, reduce_right_row(). Identical on every instruction set.

/// One row of a coarse level and its working memory.
struct PairRow {
  int columns = 0;  ///< of the images
  int lanes = 0;
  int disparity_min = 0;             ///< of candidate 0; |disparity_min + candidate| < columns
  int count = 0;                     ///< candidates
  std::uint8_t without_partner = 0;  ///< energy of candidates without a partner
  float weight = 1;                  ///< as that of reduce_compact_energies_row()
  std::uint16_t* work = nullptr;     ///< pair_row_work() numbers
};
std::size_t pair_row_work(int columns, int lanes, int disparity_min);

void start_pair_row(const PairRow& row);
/// energies: of the part's blocks. `part` starts at an even column `first_column` and ends at an
/// even one or at the end of the row; lanes that are not candidates hold 255.
void reduce_left_part(const PairRow& row, const BlockRow<std::uint8_t>& part, int first_column,
                      std::uint8_t* energies);
/// energies: of all blocks of the right image.
void reduce_right_row(const PairRow& row, std::uint8_t* energies);

}  // namespace vantage::kernels
