#include "kernels/nearest_lookup/nearest_lookup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace vantage::kernels::nearest_lookup_test {

TEST(NearestLookup, TakesTheValueAtEachPlaceAndNothingElsewhere) {
  constexpr int kWidth = 5;
  constexpr int kHeight = 3;
  constexpr int kStride = 7;
  std::vector<float> map(kStride * kHeight, -1.0F);
  std::vector<PixelPlace> places{kNoPlace};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      map[y * kStride + x] = static_cast<float>(10 * y + x);
      places.insert(places.begin(), pixel_place(x, y));
    }
  }
  std::vector<float> found(places.size());
  look_up_row(map.data(), kStride, places.data(), static_cast<int>(places.size()), found.data());
  EXPECT_TRUE(std::isnan(found.back()));
  for (std::size_t i = 0; i + 1 < found.size(); ++i) {
    EXPECT_EQ(found[i], static_cast<float>(10 * (places[i] >> 16U) + (places[i] & 0xFFFFU)));
  }
  look_up_row(map.data(), kStride, places.data(), 0, nullptr);
}

TEST(NearestLookup, PlacesOfTheLargestImagesAreNoHoles) {
  EXPECT_NE(pixel_place(65499, 65499), kNoPlace);
  EXPECT_EQ(pixel_place(65499, 65498) >> 16U, 65498U);
}

}  // namespace vantage::kernels::nearest_lookup_test
