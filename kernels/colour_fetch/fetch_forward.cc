#include <algorithm>
#include <cmath>

#include "kernels/colour_fetch/colour_fetch.h"

namespace vantage::kernels {
namespace {

template <int kLanes>
void fetch(const ForwardFetchRow& row, float* colours) {
  for (int n = 0; n < row.width; ++n, colours += kLanes) {
    const float column = row.source_column[n];
    if (std::isnan(column)) {
      std::fill_n(colours, kLanes, 0.0F);
      continue;
    }
    const int whole = static_cast<int>(column);
    const float fraction = column - static_cast<float>(whole);
    const float* pixel = row.pixels + whole * kLanes;
    for (int c = 0; c < kLanes; ++c) {
      // At fraction 0 the second pixel may be the margin; 0 · 0 leaves the first one exact.
      colours[c] = (1.0F - fraction) * pixel[c] + fraction * pixel[kLanes + c];
    }
  }
}

}  // namespace

void fetch_forward_row(const ForwardFetchRow& row, float* colours) {
  if (row.lanes == 1) {
    fetch<1>(row, colours);
  } else {
    fetch<4>(row, colours);
  }
}

}  // namespace vantage::kernels
