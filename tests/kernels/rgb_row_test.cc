#include "kernels/rgb_row/rgb_row.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::rgb_row_test {

VANTAGE_ON_EVERY_TARGET(RgbRow);

/// BT.601 in limited range.
template <typename T>
ColourFactors factors_of_601() {
  constexpr float kWhite = std::numeric_limits<T>::max();
  const float chroma = kWhite / (224 * 256);
  return {.black = 16 * 256,
          .grey = kWhite / (219 * 256),
          .red_of_red = chroma * 1.402F,
          .green_of_red = chroma * 0.714136F,
          .green_of_blue = chroma * 0.344136F,
          .blue_of_blue = chroma * 1.772F};
}

template <typename T>
void expect_the_definition() {
  std::mt19937 random(6);
  const ColourFactors factors = factors_of_601<T>();
  // The last is wide enough to show a rounding that is left out.
  for (const int width : {0, 1, 2, 31, 63, 64, 65, 127, 128, 130, 30011}) {
    const auto count = static_cast<std::size_t>(width);
    UnalignedRow<std::uint16_t> planes[3] = {
        {count, random() % 5}, {count, random() % 5}, {count, random() % 5}};
    for (auto& plane : planes) {
      for (std::size_t x = 0; x < count; ++x) {
        const unsigned extreme = random() % 8;
        plane[x] = extreme == 0 ? 0 : extreme == 1 ? 65535 : static_cast<std::uint16_t>(random());
      }
    }
    const LumaChromaRow row = {planes[0].data(), planes[1].data(), planes[2].data(), width};
    const auto reference = equal_rows<T>(
        3 * count, [&](T* out) { rgb_row(row, factors, out); },
        [&](T* out) { rgb_row_ref(row, factors, out); });
    for (std::size_t x = 0; x < count; ++x) {
      const double scale = std::numeric_limits<T>::max();
      const double luma = (planes[0][x] / 256.0 - 16) / 219 * scale;
      const double blue = (planes[1][x] / 256.0 - 128) / 224 * scale;
      const double red = (planes[2][x] / 256.0 - 128) / 224 * scale;
      const double expected[3] = {luma + 1.402 * red, luma - 0.714136 * red - 0.344136 * blue,
                                  luma + 1.772 * blue};
      for (std::size_t channel = 0; channel < 3; ++channel) {
        ASSERT_NEAR(reference[3 * x + channel], std::clamp(expected[channel], 0.0, scale),
                    0.5 + 1e-6 * scale);
      }
    }
  }
}

TEST_P(RgbRow, IsTheDefinitionIn8Bits) { expect_the_definition<std::uint8_t>(); }
TEST_P(RgbRow, IsTheDefinitionIn16Bits) { expect_the_definition<std::uint16_t>(); }

}  // namespace vantage::kernels::rgb_row_test
