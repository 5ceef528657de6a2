#include "engine/image/content_hash.h"

#include "tests/engine/engine_test.h"

namespace vantage::content_hash_test {

template <typename T>
Photograph gradient(int width, int height, int channels) {
  Image<T> image(width, height, channels);
  for (const auto [x, y] : positions_of(width, height)) {
    for (int c = 0; c < channels; ++c) {
      image.at(x, y, c) = static_cast<T>(7 * x + 3 * y + c);
    }
  }
  return {std::move(image)};
}

TEST(ContentHash, EqualPicturesHaveEqualHashesWhateverTheirMemory) {
  Image<std::uint8_t> reused(300, 200, 3);  // a larger image's rows may lie further apart
  reused.resize(31, 17, 3);
  const Photograph small = gradient<std::uint8_t>(31, 17, 3);
  const auto& pixels = std::get<Image<std::uint8_t>>(small.pixels);
  for (const auto [x, y] : positions_of(31, 17)) {
    for (int c = 0; c < 3; ++c) {
      reused.at(x, y, c) = pixels.at(x, y, c);
    }
  }
  EXPECT_EQ(content_hash({std::move(reused)}), content_hash(small));
}

TEST(ContentHash, EveryPixelAndTheShapeCount) {
  std::set<std::uint64_t> hashes;
  int pictures = 0;
  const auto add = [&](const Photograph& picture) {
    hashes.insert(content_hash(picture));
    ++pictures;
  };
  for (const int width : {1, 2, 31, 32, 33, 67}) {
    Photograph picture = gradient<std::uint8_t>(width, 3, 1);
    add(picture);
    auto& pixels = std::get<Image<std::uint8_t>>(picture.pixels);
    for (const auto [x, y] : positions_of(width, 3)) {
      for (const int change : {1, 128}) {
        pixels.at(x, y) = static_cast<std::uint8_t>(pixels.at(x, y) ^ change);
        add(picture);
        pixels.at(x, y) = static_cast<std::uint8_t>(pixels.at(x, y) ^ change);
      }
    }
  }
  add(gradient<std::uint8_t>(2, 6, 1));
  add(gradient<std::uint8_t>(4, 3, 3));
  add(gradient<std::uint16_t>(32, 3, 1));
  add(gradient<float>(32, 3, 1));
  EXPECT_EQ(hashes.size(), static_cast<std::size_t>(pictures));
}

TEST(ContentHash, PicturesWithTheSamePixels) {
  const Photograph picture = gradient<std::uint8_t>(33, 4, 3);
  EXPECT_TRUE(have_same_pixels(picture, gradient<std::uint8_t>(33, 4, 3)));
  EXPECT_FALSE(have_same_pixels(picture, gradient<std::uint16_t>(33, 4, 3)));
  EXPECT_FALSE(have_same_pixels(picture, gradient<std::uint8_t>(33, 4, 1)));
  EXPECT_FALSE(have_same_pixels(picture, gradient<std::uint8_t>(33, 5, 3)));
  Photograph last = gradient<std::uint8_t>(33, 4, 3);
  std::get<Image<std::uint8_t>>(last.pixels).at(32, 3, 2) ^= 1;
  EXPECT_FALSE(have_same_pixels(picture, last));
}

TEST(ContentHash, SwappedPixelsAndRowsDiffer) {
  Photograph picture = gradient<std::uint8_t>(64, 4, 1);
  const std::uint64_t before = content_hash(picture);
  auto& pixels = std::get<Image<std::uint8_t>>(picture.pixels);
  std::swap(pixels.at(0, 0), pixels.at(32, 0));  // equal places of two blocks
  EXPECT_NE(content_hash(picture), before);
  std::swap(pixels.at(0, 0), pixels.at(32, 0));
  for (int x = 0; x < 64; ++x) {
    std::swap(pixels.at(x, 1), pixels.at(x, 2));
  }
  EXPECT_NE(content_hash(picture), before);
}

}  // namespace vantage::content_hash_test
