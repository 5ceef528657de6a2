#include "kernels/byte_intensity/byte_intensity.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::byte_intensity_test {

VANTAGE_ON_EVERY_TARGET(ByteIntensity);

TEST_P(ByteIntensity, RoundingEqualsReference) {
  std::mt19937 random(1);
  for (std::size_t width = 1; width <= 70; ++width) {
    std::vector<float> intensities(width);
    for (float& intensity : intensities) {
      intensity = static_cast<float>(random_int(random, 0, 4 * 255)) / 4;  // ties occur
    }
    equal_rows<std::uint8_t>(width, rounded_intensity_row, rounded_intensity_row_ref,
                             intensities.data(), static_cast<int>(width));
  }
}

TEST_P(ByteIntensity, HalvingEqualsReference) {
  std::mt19937 random(2);
  for (std::size_t width = 1; width <= 150; ++width) {
    UnalignedRow<std::uint8_t> upper(width, 5), lower(width, 1);
    for (std::size_t x = 0; x < width; ++x) {
      upper[x] = static_cast<std::uint8_t>(random());
      lower[x] = static_cast<std::uint8_t>(random());
    }
    GuardedRow<std::uint8_t> halved((width + 1) / 2, 3, 77), expected((width + 1) / 2, 3, 77);
    halved_intensity_row(upper.data(), lower.data(), static_cast<int>(width), halved.data());
    halved_intensity_row_ref(upper.data(), lower.data(), static_cast<int>(width), expected.data());
    EXPECT_TRUE(halved.intact());
    EXPECT_EQ(halved.values(), expected.values());
  }
}

}  // namespace vantage::kernels::byte_intensity_test
