#include "kernels/bilateral/bilateral.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::bilateral_test {

VANTAGE_ON_EVERY_TARGET(Bilateral);

TEST_P(Bilateral, IsTheWeightedMeanOfItsDefinition) {
  std::mt19937 random(3);
  for (const int width : {1, 7, 16, 37}) {
    BilateralRow row;
    row.width = width;
    row.cut_off = 9;
    for (int v = -3; v <= 3; ++v) {
      for (int u = -3; u <= 3; ++u) {
        row.weights[static_cast<std::size_t>(v + 3)][static_cast<std::size_t>(u + 3)] =
            1.0F / static_cast<float>(1 + v * v + 2 * u * u);
      }
    }
    std::vector<std::vector<float>> pixels(7);
    for (std::size_t v = 0; v < 7; ++v) {
      for (int x = 0; x < row.width_in_whole_columns() + 6; ++x) {
        pixels[v].push_back(static_cast<float>(random_int(random, 0, 30)));
      }
      row.rows[v] = pixels[v].data() + 3;
    }
    GuardedRow<float> output(static_cast<std::size_t>(row.width_in_whole_columns()), 3, -1);
    row.output = output.data();
    bilateral_row(row);
    EXPECT_TRUE(output.intact());
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      double weights = 0;
      const double here = row.rows[3][x];
      for (int v = 0; v < 7; ++v) {
        for (int u = 0; u < 7; ++u) {
          const double there = row.rows[static_cast<std::size_t>(v)][x + u - 3];
          const double share = std::pow((there - here) / 9, 2);
          const double weight =
              share < 1 ? std::pow(1 - share, 2) *
                              row.weights[static_cast<std::size_t>(v)][static_cast<std::size_t>(u)]
                        : 0;
          sum += weight * there;
          weights += weight;
        }
      }
      ASSERT_NEAR(output.values()[static_cast<std::size_t>(x)], sum / weights, 1e-4) << x;
    }
  }
}

}  // namespace vantage::kernels::bilateral_test
