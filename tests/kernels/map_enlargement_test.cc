#include "kernels/map_enlargement/map_enlargement.h"

#include <cstring>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::map_enlargement_test {

VANTAGE_ON_EVERY_TARGET(MapEnlargement);

TEST_P(MapEnlargement, EqualsReference) {
  std::mt19937 random(31);
  for (int width = 1; width <= 90; ++width) {
    const auto columns = static_cast<std::size_t>((width + 1) / 2);
    std::vector<float> own(columns), beside(columns);
    std::vector<std::uint8_t> own_grey(columns), beside_grey(columns);
    std::vector<std::uint8_t> grey(width);
    for (std::size_t x = 0; x < columns; ++x) {
      // Steps of a quarter: some differ by exactly the limit.
      const auto draw = [&] {
        return random() % 9 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                 : static_cast<float>(random_int(random, 0, 16)) / 4;
      };
      own[x] = draw();
      beside[x] = draw();
      own_grey[x] = static_cast<std::uint8_t>(random_int(random, 0, 30));
      beside_grey[x] = static_cast<std::uint8_t>(random_int(random, 0, 30));
    }
    for (std::uint8_t& value : grey) {
      value = static_cast<std::uint8_t>(random_int(random, 0, 30));
    }
    const EnlargedRow row{own.data(),         beside.data(), own_grey.data(),
                          beside_grey.data(), grey.data(),   width};
    const auto enlarged = written_row(grey.size(), -77.0F, enlarge_map_row, row);
    std::vector<float> expected(grey.size());
    enlarge_map_row_ref(row, 0, width, expected.data());
    // Bits, because of NaN.
    EXPECT_EQ(std::memcmp(enlarged.data(), expected.data(), sizeof(float) * grey.size()), 0)
        << width;
  }
}

TEST_P(MapEnlargement, IsLinearOnASurfaceAndFollowsIntensitiesAtAJump) {
  const float own[] = {10, 10.5F, 30, 30};
  const std::uint8_t own_grey[] = {50, 50, 200, 200};
  // Pixel 3 looks like the column to its right, pixel 4 like its own.
  const std::uint8_t grey[] = {50, 50, 50, 200, 200, 200, 200, 200};
  float enlarged[8];
  enlarge_map_row({own, own, own_grey, own_grey, grey, 8}, enlarged);
  const float expected[] = {10, 10.125F, 10.375F, 30, 30, 30, 30, 30};
  for (std::size_t x = 0; x < 8; ++x) {
    EXPECT_EQ(enlarged[x], expected[x]) << x;
  }
}

}  // namespace vantage::kernels::map_enlargement_test
