// Matches a generated pair in memory with the installed library and checks the disparity.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "engine/vantage.h"

namespace {

constexpr int kWidth = 97;
constexpr int kHeight = 61;
constexpr int kDisparityPx = 5;
/// Bytes from row to row: BGR, and some that belong to no pixel.
constexpr std::ptrdiff_t kRowBytes = 3 * kWidth + 13;

vantage::Photograph photograph(const std::vector<std::uint8_t>& bytes) {
  return vantage::photograph_of(
      vantage::PixelBuffer<std::uint8_t>{.data = bytes.data(),
                                         .width_px = kWidth,
                                         .height_px = kHeight,
                                         .channels = 3,
                                         .row_bytes = kRowBytes,
                                         .order = vantage::ChannelOrder::kBgr});
}

}  // namespace

int main() {
  std::vector<std::uint8_t> left(static_cast<std::size_t>(kRowBytes * kHeight));
  std::vector<std::uint8_t> right(left.size());
  std::mt19937 random(1);
  for (std::uint8_t& byte : left) {
    byte = static_cast<std::uint8_t>(random() >> 24U);
  }
  for (std::size_t i = 0; i + 3 * kDisparityPx < left.size(); ++i) {
    right[i] = left[i + 3 * kDisparityPx];
  }

  vantage::MatchOptions options;
  options.disparities_auto = true;
  const vantage::PairMatcher matcher(options);
  vantage::DisparityMaps maps;
  const vantage::DisparityRange range =
      matcher.match(photograph(left), photograph(right), {.right = false}, maps).disparities;

  int wrong = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = kDisparityPx + 3; x < kWidth - 3; ++x) {
      const float error_px = std::abs(maps.left.disparity_px.at(x, y) - float{kDisparityPx});
      wrong += error_px <= 0.25F ? 0 : 1;  // NaN, an unknown disparity, counts as wrong
    }
  }
  std::printf("consumer: disparities %d:%d, %d of %d pixels off the true disparity of %d px\n",
              range.min, range.max, wrong, (kWidth - kDisparityPx - 6) * kHeight, kDisparityPx);
  return wrong == 0 ? 0 : 1;
}
