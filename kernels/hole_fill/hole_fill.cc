#include "kernels/hole_fill/hole_fill.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "kernels/row_bits/row_bits.h"

namespace vantage::kernels {
namespace {

// Number of pixels, at most `wanted`, from `start` in direction `step` that are on one surface.
int run_length(const float* disparity_px, int width, int start, int step, int wanted, float limit) {
  int length = 1;
  for (int x = start + step; x >= 0 && x < width && length < wanted; x += step, ++length) {
    // Not ">": a NaN (another hole) must also end the run.
    if (!(std::abs(disparity_px[x] - disparity_px[x - step]) <= limit)) {
      break;
    }
  }
  return length;
}

template <typename T>
void fill_hole(const HoleFillRow<T>& row, int begin, int end, bool mirror) {
  const bool has_left = begin > 0;
  const bool has_right = end < row.width;
  const bool from_left =
      has_left && !(has_right && row.disparity_px[end] < row.disparity_px[begin - 1]);
  int start = from_left ? begin - 1 : end;
  const int step = from_left ? -1 : 1;
  if (row.mixed_px > 0 && has_left && has_right &&
      std::abs(row.disparity_px[end] - row.disparity_px[begin - 1]) > row.gradient_limit_px) {
    const int mixed = run_length(row.disparity_px, row.width, start, step, row.mixed_px + 1,
                                 row.gradient_limit_px) -
                      1;
    start += mixed * step;
    begin -= from_left ? mixed : 0;
    end += from_left ? 0 : mixed;
  }
  const int count = end - begin;
  const int run =
      mirror ? run_length(row.disparity_px, row.width, start, step, count, row.gradient_limit_px)
             : 1;
  if (row.filled_disparity_px != nullptr) {
    std::fill_n(row.filled_disparity_px + begin, count, row.disparity_px[start]);
  }
  if (row.filled != nullptr) {
    std::fill_n(row.filled + begin, count, std::uint8_t{255});
  }
  int position = 0;  // within s0 … s(run−1), traversed back and forth
  int direction = 1;
  for (int k = 0; k < count; ++k) {
    const int target = from_left ? begin + k : end - 1 - k;
    std::copy_n(row.pixels + (start + position * step) * row.channels, row.channels,
                row.pixels + target * row.channels);
    position += direction;
    if (position < 0 || position == run) {
      position -= direction;
      direction = -direction;
    }
  }
}

template <typename T>
void fill_holes(const HoleFillRow<T>& row, bool mirror) {
  if (row.filled_disparity_px != nullptr) {
    std::copy_n(row.disparity_px, row.width, row.filled_disparity_px);
  }
  if (row.filled != nullptr) {
    std::fill_n(row.filled, row.width, std::uint8_t{0});
  }
  constexpr int kBlock = 1024;
  std::uint64_t known[row_words(kBlock)];
  int end = 0;  // of the last hole
  for (int first = 0; first < row.width; first += kBlock) {
    const int count = std::min(kBlock, row.width - first);
    const float* disparity_px = row.disparity_px + first;
    near_bits_row(disparity_px, disparity_px, 0, count, known);
    for (int word = 0; word < row_words(count); ++word) {
      for (std::uint64_t open = ~known[word]; open != 0; open &= open - 1) {
        const int begin = first + 64 * word + std::countr_zero(open);
        if (begin < end || begin >= row.width) {
          continue;
        }
        end = begin;
        while (end < row.width && std::isnan(row.disparity_px[end])) {
          ++end;
        }
        if (begin > 0 || end < row.width) {
          fill_hole(row, begin, end, mirror);
        }
      }
    }
  }
}

}  // namespace

void fill_holes_row(const HoleFillRow<std::uint8_t>& row, bool mirror) { fill_holes(row, mirror); }
void fill_holes_row(const HoleFillRow<std::uint16_t>& row, bool mirror) { fill_holes(row, mirror); }
void fill_holes_row(const HoleFillRow<float>& row, bool mirror) { fill_holes(row, mirror); }

}  // namespace vantage::kernels
