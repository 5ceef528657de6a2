#include "kernels/bilateral/bilateral.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::bilateral_test {

VANTAGE_ON_EVERY_TARGET(Bilateral);

/// The weighted mean of the definition, of column x, in steps.
double mean_at(const BilateralRow& row, int x) {
  double sum = 0;
  double weights = 0;
  const double here = row.pixels[x];
  const auto add = [&](double there, double weight) {
    const double share = std::pow((there - here) / row.cut_off, 2);
    weight *= share < 1 ? std::pow(1 - share, 2) : 0;
    sum += weight * there;
    weights += weight;
  };
  add(here, 1);
  for (const BilateralPair& pair : row.pairs) {
    const double weight = static_cast<double>(pair.weight) / kBilateralOne;
    add(pair.before[x], weight);
    add(pair.after[x], weight);
  }
  return sum / weights;
}

TEST_P(Bilateral, IsTheWeightedMeanOfItsDefinition) {
  std::mt19937 random(3);
  for (const auto& [width, pair_count, cut_off, spread] :
       {std::tuple{1, 2, 20, 30}, std::tuple{7, 3, 20, 255}, std::tuple{33, 24, 10, 14},
        std::tuple{70, 24, 128, 255}, std::tuple{31, 24, 180, 255}, std::tuple{40, 0, 4, 255},
        std::tuple{64, 1, 4, 6}}) {
    BilateralRow row{.width = width, .cut_off = cut_off * kBilateralUnit};
    std::vector<std::vector<std::int16_t>> pixels;
    for (int i = 0; i <= 2 * pair_count; ++i) {
      pixels.emplace_back();
      for (int x = 0; x < row.width_in_whole_columns(); ++x) {
        pixels.back().push_back(
            static_cast<std::int16_t>(random_int(random, 0, spread * kBilateralUnit)));
      }
    }
    std::vector<BilateralPair> pairs;
    for (std::size_t i = 1; i < pixels.size(); i += 2) {
      pairs.push_back({pixels[i].data(), pixels[i + 1].data(),
                       static_cast<std::int16_t>(32000 / (i + 1) + 300)});
    }
    row.pixels = pixels[0].data();
    row.pairs = pairs;
    GuardedRow<std::int16_t> output(static_cast<std::size_t>(row.width_in_whole_columns()), 3, -1);
    row.output = output.data();
    bilateral_row(row);
    EXPECT_TRUE(output.intact());
    for (int x = 0; x < width; ++x) {
      ASSERT_NEAR(output.values()[static_cast<std::size_t>(x)], mean_at(row, x), kBilateralUnit / 4)
          << width << " " << pair_count << " " << x;
    }
  }
}

TEST_P(Bilateral, StepsAreRoundedAndClipped) {
  std::vector<float> levels(kBilateralColumns, 0.0F);
  levels[0] = 255;
  levels[1] = -3;
  levels[2] = 1000;
  levels[3] = 1.0F / 3;
  std::vector<std::int16_t> steps(kBilateralColumns, -1);
  bilateral_steps_row(levels.data(), 4, steps.data());
  EXPECT_EQ(std::vector(steps.begin(), steps.begin() + 4),
            (std::vector<std::int16_t>{32640, 0, 32767, 43}));
}

}  // namespace vantage::kernels::bilateral_test
