#include "kernels/chroma_rows/chroma_rows.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::chroma_rows_test {

VANTAGE_ON_EVERY_TARGET(ChromaRows);

/// BT.601 in full range, where blue and red reach the limits.
constexpr ChromaFactors kFactors = {.luma = {9798, 19234, 3736},
                                    .chroma_blue = {-5529, -10855, 16384},
                                    .chroma_red = {16384, -13720, -2664},
                                    .black = 0};

TEST_P(ChromaRows, AreTheDefinition) {
  std::mt19937 random(3);
  for (const int width : {2, 4, 30, 126, 128, 130, 256, 258, 1000}) {
    const auto count = static_cast<std::size_t>(width);
    UnalignedRow<std::uint8_t> rgb[2] = {{3 * count, random() % 5}, {3 * count, random() % 5}};
    for (auto& row : rgb) {
      for (std::size_t i = 0; i < 3 * count; ++i) {
        const unsigned extreme = random() % 4;
        row[i] = extreme == 0 ? 0 : extreme == 1 ? 255 : static_cast<std::uint8_t>(random());
      }
    }
    for (const int black : {0, 16}) {
      ChromaFactors factors = kFactors;
      factors.black = black;
      // One value more than is written, which must stay.
      std::vector<std::uint8_t> luma[2] = {std::vector<std::uint8_t>(count + 1, 77),
                                           std::vector<std::uint8_t>(count + 1, 77)};
      std::vector<std::uint8_t> blue(count / 2 + 1, 77);
      std::vector<std::uint8_t> red(count / 2 + 1, 77);
      chroma_rows({.rgb = {rgb[0].data(), rgb[1].data()},
                   .luma = {luma[0].data(), luma[1].data()},
                   .chroma_blue = blue.data(),
                   .chroma_red = red.data(),
                   .width = width},
                  factors);
      const auto code = [](double level) {
        return static_cast<int>(std::clamp(std::floor(level + 0.5), 0.0, 255.0));
      };
      const auto product = [](const std::array<std::int32_t, 3>& f, const double* levels) {
        return (f[0] * levels[0] + f[1] * levels[1] + f[2] * levels[2]) / 32768;
      };
      for (std::size_t x = 0; x < count; ++x) {
        for (std::size_t row = 0; row < 2; ++row) {
          const double levels[3] = {double(rgb[row][3 * x]), double(rgb[row][3 * x + 1]),
                                    double(rgb[row][3 * x + 2])};
          ASSERT_EQ(luma[row][x], code(black + product(factors.luma, levels))) << width << " " << x;
        }
        if (x % 2 == 0) {
          double mean[3];
          for (std::size_t c = 0; c < 3; ++c) {
            const auto both = [&](std::size_t at) {
              return (rgb[0][3 * at + c] + rgb[1][3 * at + c]) / 2.0;
            };
            mean[c] = (both(x == 0 ? 0 : x - 1) + 2 * both(x) + both(x + 1)) / 4;
          }
          ASSERT_EQ(blue[x / 2], code(128 + product(factors.chroma_blue, mean))) << width;
          ASSERT_EQ(red[x / 2], code(128 + product(factors.chroma_red, mean))) << width;
        }
      }
      EXPECT_EQ(luma[0][count] + luma[1][count] + blue[count / 2] + red[count / 2], 4 * 77);
    }
  }
}

}  // namespace vantage::kernels::chroma_rows_test
