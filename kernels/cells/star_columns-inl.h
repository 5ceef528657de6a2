// Iterates over the columns of a row of stars. Included once per target by dispatched files.

#if defined(VANTAGE_KERNELS_CELLS_STAR_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_CELLS_STAR_COLUMNS_INL_H_
#undef VANTAGE_KERNELS_CELLS_STAR_COLUMNS_INL_H_
#else
#define VANTAGE_KERNELS_CELLS_STAR_COLUMNS_INL_H_
#endif

#include <type_traits>

#include "kernels/simd-inl.h"
#include "kernels/star_row.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Pointers to the columns of a star.
template <typename Cell>
struct StarColumns {
  const Cell* centre;
  const Cell* left;
  const Cell* right;
  const Cell* up;
  const Cell* down;
  const Cell* source;
  int x;
};

// Calls column(columns, output) for each column of the row, left to right. Row must have star,
// source_pitch, output and output_pitch.
template <class Row, class Column>
HWY_INLINE void each_column(const Row& row, Column column) {
  const auto& star = row.star;
  using Cell = std::remove_pointer_t<decltype(row.output)>;
  StarColumns<Cell> at{
      star.centre, star.left_of_first, star.centre, star.up, star.down, star.source, 0};
  auto* output = row.output;
  for (; at.x < star.columns; ++at.x) {
    at.right = at.x + 1 < star.columns ? at.centre + star.pitch : star.right_of_last;
    column(at, output);
    at.left = at.centre;
    at.centre += star.pitch;
    at.up += star.up_pitch;
    at.down += star.down_pitch;
    at.source += row.source_pitch;
    output += row.output_pitch;
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
