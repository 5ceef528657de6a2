#include <algorithm>
#include <cmath>

#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/pixel_row/pixel_row.h"

namespace vantage::kernels {

void fetch_forward_row(const ForwardFetchRow& row, float* colours) {
  const int lanes = pixel_lanes(row.channels);
  for (int n = 0; n < row.width; ++n, colours += lanes) {
    const float column = row.source_column[n];
    std::fill_n(colours, lanes, 0.0F);
    if (std::isnan(column)) {
      continue;
    }
    const int whole = static_cast<int>(column);
    const float fraction = column - static_cast<float>(whole);
    const float* pixel = row.pixels + whole;
    for (int c = 0; c < row.channels; ++c, pixel += row.stride) {
      // At fraction 0 the second pixel may be the margin; 0 · 0 leaves the first one exact.
      colours[c] = (1.0F - fraction) * pixel[0] + fraction * pixel[1];
    }
  }
}

}  // namespace vantage::kernels
