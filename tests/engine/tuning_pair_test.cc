#include "engine/tuning/tuning_pair.h"

#include "tests/engine/engine_test.h"

namespace vantage::tuning_pair_test {

TEST(TuningPair, IsOfTheSizeAskedFor) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 500), std::pair(300, 1)}) {
    for (const bool grey : {false, true}) {
      const TuningPair pair = make_tuning_pair(width, height, {0, 63}, grey, execution());
      EXPECT_EQ(pair.left.width(), width);
      EXPECT_EQ(pair.right.height(), height);
      EXPECT_EQ(pair.left.channels(), grey ? 1 : 3);
    }
  }
  const TuningPair top = top_rows(make_tuning_pair(8, 400, {-20, 5}, true, execution()), 7);
  EXPECT_EQ(top.left.height(), 7);
}

TEST(TuningPair, TheRightImageShowsTheLeftOneShifted) {
  // Of the squares of differences at all shifts of the range, the least is far below the mean one:
  // the pair can be matched.
  for (const DisparityRange range : {DisparityRange{0, 31}, DisparityRange{-31, 0}}) {
    const TuningPair pair = make_tuning_pair(200, 40, range, true, execution());
    const auto& left = std::get<Image<std::uint8_t>>(pair.left.pixels);
    const auto& right = std::get<Image<std::uint8_t>>(pair.right.pixels);
    double min_sum = 0;
    double mean_sum = 0;
    for (int x = 50; x < 150; ++x) {
      double min = 1e9;
      double sum = 0;
      for (int d = range.min; d <= range.max; ++d) {
        double difference = 0;
        for (int y = 10; y < 20; ++y) {
          const double delta = left.at(x, y) - right.at(x - d, y);
          difference += delta * delta;
        }
        min = std::min(min, difference);
        sum += difference;
      }
      min_sum += min;
      mean_sum += sum / range.count();
    }
    EXPECT_LT(min_sum, 0.4 * mean_sum);
  }
}

}  // namespace vantage::tuning_pair_test
