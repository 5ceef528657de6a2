#include "kernels/fill_unmatched/fill_unmatched.h"

#include <algorithm>

namespace vantage::kernels {

bool fill_unmatched_row(const std::uint8_t* unmatched, BackgroundSide side, int width,
                        float* disparity_px) {
  bool any_matched = false;
  for (int begin = 0; begin < width;) {
    if (unmatched[begin] == 0) {
      any_matched = true;
      ++begin;
      continue;
    }
    int end = begin;
    while (end < width && unmatched[end] != 0) {
      ++end;
    }
    if (begin == 0 && end == width) {
      return false;
    }
    const bool from_left = end == width || (side == BackgroundSide::kLeft && begin > 0);
    const float background = from_left ? disparity_px[begin - 1] : disparity_px[end];
    std::fill(disparity_px + begin, disparity_px + end, background);
    begin = end;
  }
  return any_matched;
}

}  // namespace vantage::kernels
