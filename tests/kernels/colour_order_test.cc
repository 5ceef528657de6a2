#include "kernels/colour_order/colour_order.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::colour_order_test {

VANTAGE_ON_EVERY_TARGET(ColourOrder);

template <typename T>
void expect_the_definition() {
  std::mt19937 random(3);
  for (const int width : {0, 1, 2, 15, 16, 31, 64, 65, 130, 1001}) {
    const auto pixels_count = static_cast<std::size_t>(width);
    UnalignedRow<T> pixels(3 * pixels_count, random() % 5);
    for (std::size_t i = 0; i < 3 * pixels_count; ++i) {
      pixels[i] = static_cast<T>(random() % 65536);
    }
    const auto reference = equal_rows<T>(
        3 * pixels_count, [&](T* out) { opposite_colour_order_row(pixels.data(), width, out); },
        [&](T* out) { opposite_colour_order_row_ref(pixels.data(), width, out); });
    for (std::size_t x = 0; x < pixels_count; ++x) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        ASSERT_EQ(reference[3 * x + channel], pixels[3 * x + 2 - channel]);
      }
    }
  }
}

TEST_P(ColourOrder, IsTheDefinitionIn8Bits) { expect_the_definition<std::uint8_t>(); }
TEST_P(ColourOrder, IsTheDefinitionIn16Bits) { expect_the_definition<std::uint16_t>(); }
TEST_P(ColourOrder, IsTheDefinitionInFloats) { expect_the_definition<float>(); }

}  // namespace vantage::kernels::colour_order_test
