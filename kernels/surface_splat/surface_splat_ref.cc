#include <algorithm>

#include "kernels/surface_splat/quad_gaps.h"
#include "kernels/surface_splat/surface_splat.h"

namespace vantage::kernels {

void splat_rows_ref(const SplatRows& rows, const SplatBand& band) {
  for (int i = 0; i < rows.count; ++i) {
    const int column = rows.upper.column[i];
    const int line = rows.upper.line[i] - band.first_line;
    if (column >= 0 && column < band.width && line >= 0 && line < band.lines) {
      float& nearest = band.nearness[line * band.stride + column];
      nearest = std::max(nearest, rows.upper.nearness[i]);
    }
    if (!rows.view.is_translation && is_torn(rows, i)) {
      fill_torn_quad(rows, i, band);
    } else {
      fill_quad_gaps(rows, quad_at(rows, i), band);
    }
  }
}

}  // namespace vantage::kernels
