#include "kernels/integer_disparity/integer_disparity.h"

#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::integer_disparity_test {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Values at and beside halves and limits, unknown ones among them.
std::vector<float> disparities(std::mt19937& random, int width) {
  std::vector<float> row(width);
  for (float& d : row) {
    const float at = static_cast<float>(random() % 65535) / 256 + 0.5F / 256;
    constexpr float kOthers[] = {0,         -0.499F / 256, 1e-30F,          kUnknownDisparity,
                                 kInfinity, -kInfinity,    65535.49F / 256, -0.0F};
    switch (random() % 5) {
      case 0:
        d = at;
        break;
      case 1:
        d = std::nextafter(at, 0.0F);
        break;
      case 2:
        d = std::nextafter(at, 1000.0F);
        break;
      default:
        d = kOthers[random() % 8];
    }
    if (d * 256 >= 65535.5F) {
      d = 7;
    }
  }
  return row;
}

TEST(IntegerDisparity, EqualOnEveryInstructionSetAndToReference) {
  std::mt19937 random(12);
  for (const int width : kAwkwardWidths) {
    std::vector<float> row = disparities(random, width);
    for (const float misfit : {7.0F, -0.5F / 256, 65535.5F / 256, 1e30F, -3.0F}) {
      row[random() % row.size()] = misfit;
      std::vector<std::uint16_t> expected(row.size());
      const int fitting = integer_disparity_row_ref(row.data(), width, expected.data());
      ASSERT_EQ(fitting == width, misfit == 7.0F);
      for_each_target([&] {
        std::vector<std::uint16_t> stored(row.size());
        ASSERT_EQ(integer_disparity_row(row.data(), width, stored.data()), fitting);
        for (std::size_t x = 0; x < static_cast<std::size_t>(fitting); ++x) {
          ASSERT_EQ(stored[x], expected[x]) << row[x];
        }
      });
      row[fitting % width] = 7;
    }
  }
}

}  // namespace vantage::kernels::integer_disparity_test
