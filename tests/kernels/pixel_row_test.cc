#include "kernels/pixel_row/pixel_row.h"

#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::pixel_row_test {

template <typename T>
class PixelRow : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, std::uint16_t, float>;
TYPED_TEST_SUITE(PixelRow, PixelTypes);

TYPED_TEST(PixelRow, PlanesOfWidenedPixels) {
  std::mt19937 random(7);
  for (const int width : kAwkwardWidths) {
    for (const int channels : {1, 3, 4}) {
      // Of exactly the size that may be read: the address sanitizer sees any excess.
      std::vector<TypeParam> pixels(width * channels);
      for (TypeParam& value : pixels) {
        value = static_cast<TypeParam>(random() % 60000);
      }
      const int stride = width + 2 * kRowMarginPx + 3;
      std::vector<float> expected(stride * channels, -1.0F);
      for (int c = 0; c < channels; ++c) {
        std::fill_n(expected.begin() + c * stride, width + 2 * kRowMarginPx, 0.0F);
        for (int x = 0; x < width; ++x) {
          expected[c * stride + kRowMarginPx + x] = static_cast<float>(pixels[x * channels + c]);
        }
      }
      std::vector<float> planes;
      for_each_target([&] {
        planes.assign(expected.size(), -1.0F);
        load_pixel_planes(pixels.data(), width, channels, stride, planes.data() + kRowMarginPx);
        ASSERT_EQ(planes, expected) << width << " wide, " << channels << " channels";
      });
    }
  }
}

}  // namespace vantage::kernels::pixel_row_test
