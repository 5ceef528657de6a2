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

/// Whether the run [begin, end) lies between two pixels of one surface.
bool is_one_surface(int begin, int end, int width, const SurfaceStep& step,
                    const float* disparity_px) {
  return begin > 0 && end < width &&
         std::abs(disparity_px[end] - disparity_px[begin - 1]) <=
             step.px + step.px_per_column * static_cast<float>(end - begin + 1);
}

float background_of(int begin, int end, int width, BackgroundSide side, const float* disparity_px) {
  if (begin == 0) {
    return disparity_px[end];
  }
  if (end == width) {
    return disparity_px[begin - 1];
  }
  if (side == BackgroundSide::kFarther) {
    return std::min(disparity_px[begin - 1], disparity_px[end]);
  }
  return disparity_px[side == BackgroundSide::kLeft ? begin - 1 : end];
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
  constexpr SurfaceStep kNoStep = {.px = -1};
  return fill_unmatched_row_linearly(unmatched, side, kNoStep, width, disparity_px);
}

bool fill_unmatched_row_linearly(const std::uint8_t* unmatched, BackgroundSide side,
                                 const SurfaceStep& step, int width, float* disparity_px) {
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
    if (is_one_surface(begin, end, width, step, disparity_px)) {
      interpolate(begin, end, disparity_px);
    } else {
      std::fill(disparity_px + begin, disparity_px + end,
                background_of(begin, end, width, side, disparity_px));
    }
    begin = end;
  }
  return any_matched;
}

}  // namespace vantage::kernels
