// Matches a generated pair with the installed library and checks the disparity.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <utility>

#include "engine/vantage.h"

int main() {
  constexpr int kWidth = 97;
  constexpr int kHeight = 61;
  constexpr int kDisparityPx = 5;

  vantage::Image<std::uint8_t> left(kWidth, kHeight);
  vantage::Image<std::uint8_t> right(kWidth, kHeight);
  std::mt19937 random(1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      left.at(x, y) = static_cast<std::uint8_t>(random() >> 24U);
    }
    for (int x = 0; x < kWidth; ++x) {
      const int source_x = x + kDisparityPx;
      right.at(x, y) = source_x < kWidth ? left.at(source_x, y) : std::uint8_t{0};
    }
  }

  vantage::ExecutionOptions execution_options;
  execution_options.threads = 2;
  vantage::Execution execution(execution_options);

  vantage::MatchOptions options;
  options.disparities = {0, 15};
  options.parameters.iterations = 4;
  const vantage::StereoMatcher matcher(options, execution);

  vantage::DisparityMaps maps;
  matcher.match({std::move(left)}, {std::move(right)}, {}, maps);

  int wrong = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = kDisparityPx + 3; x < kWidth - 3; ++x) {
      const float error_px = std::abs(maps.left.disparity_px.at(x, y) - float{kDisparityPx});
      wrong += error_px <= 0.25F ? 0 : 1;  // NaN, an unknown disparity, counts as wrong
    }
  }
  std::printf("consumer: %d of %d pixels off the true disparity of %d px\n", wrong,
              (kWidth - kDisparityPx - 6) * kHeight, kDisparityPx);
  return wrong == 0 ? 0 : 1;
}
