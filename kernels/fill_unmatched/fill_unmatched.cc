#include "kernels/fill_unmatched/fill_unmatched.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vantage::kernels {
namespace {

void interpolate(int begin, int end, float* disparity_px) {
  const float before = disparity_px[begin - 1];
  const float slope = (disparity_px[end] - before) / static_cast<float>(end - begin + 1);
  for (int x = begin; x < end; ++x) {
    disparity_px[x] = before + slope * static_cast<float>(x - begin + 1);
  }
}

/// First unmatched pixel at or after `x`, or `width`.
int next_unmatched(const std::uint8_t* unmatched, int x, int width) {
  constexpr int kWordBytes = 8;
  for (; x + kWordBytes <= width; x += kWordBytes) {
    std::uint64_t word = 0;
    std::memcpy(&word, unmatched + x, kWordBytes);
    if (word != 0) {
      break;
    }
  }
  while (x < width && unmatched[x] == 0) {
    ++x;
  }
  return x;
}

}  // namespace

bool fill_unmatched_row(const std::uint8_t* unmatched, BackgroundSide side, int width,
                        float* disparity_px) {
  constexpr float kNoStep = -1;
  return fill_unmatched_row_linearly(unmatched, side, kNoStep, width, disparity_px);
}

bool fill_unmatched_row_linearly(const std::uint8_t* unmatched, BackgroundSide side, float step_px,
                                 int width, float* disparity_px) {
  bool any_matched = false;
  for (int begin = 0; begin < width;) {
    const int matched_from = begin;
    begin = next_unmatched(unmatched, begin, width);
    any_matched = any_matched || begin > matched_from;
    if (begin == width) {
      break;
    }
    int end = begin;
    while (end < width && unmatched[end] != 0) {
      ++end;
    }
    if (begin == 0 && end == width) {
      return false;
    }
    if (begin > 0 && end < width &&
        std::abs(disparity_px[end] - disparity_px[begin - 1]) <= step_px) {
      interpolate(begin, end, disparity_px);
    } else {
      const bool from_left = end == width || (side == BackgroundSide::kLeft && begin > 0);
      const float background = from_left ? disparity_px[begin - 1] : disparity_px[end];
      std::fill(disparity_px + begin, disparity_px + end, background);
    }
    begin = end;
  }
  return any_matched;
}

}  // namespace vantage::kernels
