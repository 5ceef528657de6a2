#include "kernels/window_correlation/window_correlation.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::window_correlation_test {

VANTAGE_ON_EVERY_TARGET(WindowCorrelation);

std::vector<float> random_row(std::mt19937& random, int width) {
  std::vector<float> row;
  for (int x = 0; x < width; ++x) {
    row.push_back(static_cast<float>(random_int(random, -200, 200)) / 16);
  }
  return row;
}

TEST_P(WindowCorrelation, IsTheSumOverTheWindowWhereItIsBetter) {
  std::mt19937 random(5);
  for (const auto& [begin, end, rows] :
       {std::tuple{4, 5, 7}, std::tuple{1, 40, 1}, std::tuple{9, 76, 7}}) {
    std::vector<std::vector<float>> values;
    for (int i = 0; i < 2 * rows + 2; ++i) {
      values.push_back(random_row(random, end + 1));
    }
    std::vector<float> sums(static_cast<std::size_t>(end) + 1);
    CorrelationRow row{.rows = rows,
                       .scale = values[values.size() - 2].data(),
                       .partner_scale = values.back().data(),
                       .begin = begin,
                       .end = end,
                       .sums = sums.data()};
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows); ++i) {
      row.values[i] = values[2 * i].data();
      row.partners[i] = values[2 * i + 1].data();
    }
    const std::vector<float> before = random_row(random, end + 1);
    std::vector<float> best = before;
    std::vector<float> place(best.size(), 7.0F);
    correlation_row(row, -2, best.data(), place.data());
    for (int x = 0; x <= end; ++x) {
      const auto i = static_cast<std::size_t>(x);
      double r = 0;
      for (std::size_t k = 0; x >= begin && x < end && k < static_cast<std::size_t>(rows); ++k) {
        for (const int column : {x - 1, x, x + 1}) {
          r += double{row.values[k][column]} * row.partners[k][column];
        }
      }
      r *= double{row.scale[x]} * row.partner_scale[x];
      const bool is_better = x >= begin && x < end && r > before[i];
      ASSERT_NEAR(best[i], is_better ? r : before[i], 1e-5 * std::abs(r)) << x;
      ASSERT_EQ(place[i], is_better ? -2 : 7) << x;
    }
  }
}

TEST_P(WindowCorrelation, TheSecondIsTheBestApart) {
  constexpr int kWidth = 37;
  constexpr int kPartners = 30;
  constexpr int kPeak = 4;
  std::mt19937 random(6);
  std::vector<std::vector<float>> all;
  for (int i = 0; i < kPartners; ++i) {
    all.push_back(random_row(random, kWidth));
  }
  const std::vector<float> none(kWidth, -100.0F);
  std::vector<float> best = none;
  std::vector<float> second = none;
  std::vector<float> offset(kWidth, 0.0F);
  std::vector<float> place(kWidth, 0.0F);
  std::vector<float> before = none;  // the best of those more than kPeak before
  for (int i = 0; i < kPartners; ++i) {
    for (std::size_t x = 0; i > kPeak && x < kWidth; ++x) {
      before[x] = std::max(before[x], all[static_cast<std::size_t>(i - kPeak - 1)][x]);
    }
    const std::vector<float> here(kWidth, static_cast<float>(2 * i));
    add_partners_row(all[static_cast<std::size_t>(i)].data(), here.data(), before.data(),
                     static_cast<float>(i), kPeak, kWidth,
                     {best.data(), second.data(), offset.data(), place.data()});
  }
  for (std::size_t x = 0; x < kWidth; ++x) {
    std::size_t first = 0;
    for (std::size_t i = 1; i < kPartners; ++i) {
      first = all[i][x] > all[first][x] ? i : first;
    }
    ASSERT_EQ(best[x], all[first][x]) << x;
    ASSERT_EQ(offset[x], static_cast<float>(first)) << x;
    ASSERT_EQ(place[x], static_cast<float>(2 * first)) << x;
    float apart = -100;
    for (std::size_t i = 0; i < kPartners; ++i) {
      if (std::abs(static_cast<int>(i) - static_cast<int>(first)) > kPeak) {
        apart = std::max(apart, all[i][x]);
      }
    }
    // What was near a peak that was exceeded later, and is apart from the last, may be missed.
    ASSERT_LE(second[x], apart) << x;
    if (first + kPeak < kPartners && first > kPeak) {
      ASSERT_GT(second[x], -100) << x;
    }
  }
}

}  // namespace vantage::kernels::window_correlation_test
