#include "kernels/pixel_row/pixel_row.h"

#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::pixel_row_test {

template <typename T>
class PixelRow : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, std::uint16_t, float>;
TYPED_TEST_SUITE(PixelRow, PixelTypes);

TYPED_TEST(PixelRow, WidensPixelsAndClearsTheRest) {
  std::mt19937 random(7);
  for (const int width : kAwkwardWidths) {
    for (const int channels : {1, 3, 4}) {
      // Of exactly the size that may be read: the address sanitizer sees any excess.
      std::vector<TypeParam> pixels(width * channels);
      for (TypeParam& value : pixels) {
        value = static_cast<TypeParam>(random() % 60000);
      }
      const int lanes = pixel_lanes(channels);
      const int margin = kRowMarginPx * lanes;
      std::vector<float> expected(width * lanes + 2 * margin, 0.0F);
      for (int x = 0; x < width; ++x) {
        for (int c = 0; c < channels; ++c) {
          expected[margin + x * lanes + c] = static_cast<float>(pixels[x * channels + c]);
        }
      }
      std::vector<float> row;
      for_each_target([&] {
        row.assign(expected.size(), -1.0F);
        load_pixel_row(pixels.data(), width, channels, row.data() + margin);
        ASSERT_EQ(row, expected) << width << " wide, " << channels << " channels";
      });
    }
  }
}

}  // namespace vantage::kernels::pixel_row_test
