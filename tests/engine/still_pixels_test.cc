#include "engine/sequence/past/still_pixels.h"

#include "engine/generation/portable_random.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/plain_still_pixels.h"

namespace vantage::still_pixels_test {

Image<std::uint8_t> random_levels(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Image<std::uint8_t> levels(width, height);
  for (const auto [x, y] : positions_of(width, height)) {
    levels.at(x, y) = static_cast<std::uint8_t>(random());
  }
  return levels;
}

TEST(StillPixels, FollowTheDefinition) {
  struct Size {
    int width;
    int height;
  };
  Mask still;
  for (const Size size : {Size{1, 1}, {1, 40}, {40, 1}, {2, 3}, {67, 35}, {130, 18}}) {
    const auto before = random_levels(size.width, size.height, 1);
    auto now = before.copy();
    std::mt19937 random(2);
    for (int k = 0; k < size.width * size.height / 60 + 1; ++k) {
      const int x = static_cast<int>(random() % static_cast<unsigned>(size.width));
      const int y = static_cast<int>(random() % static_cast<unsigned>(size.height));
      now.at(x, y) = static_cast<std::uint8_t>(random());
    }
    for (const double threshold : {0.0, 1.0, 3.0, 3.4, 20.0, 255.0}) {
      const std::int64_t count = StillPixels(threshold).find(before, now, execution(), still);
      std::int64_t expected = 0;
      for (const auto [x, y] : positions_of(size.width, size.height)) {
        const bool wanted = is_still(before, now, x, y, threshold);
        expected += wanted ? 1 : 0;
        ASSERT_EQ(still.at(x, y), wanted ? 255 : 0)
            << x << ", " << y << " of " << size.width << "x" << size.height;
      }
      ASSERT_EQ(count, expected);
    }
  }
}

TEST(StillPixels, NoiseOfTwoGreyLevelsPassesTheDefaultThreshold) {
  Image<std::uint8_t> frames[2] = {Image<std::uint8_t>(200, 100), Image<std::uint8_t>(200, 100)};
  PortableRandom random(3);
  for (auto& frame : frames) {
    for (const auto [x, y] : positions_of(200, 100)) {
      frame.at(x, y) = static_cast<std::uint8_t>(std::lround(100 + 2 * random.normal()));
    }
  }
  Mask still;
  EXPECT_GE(StillPixels(3).find(frames[0], frames[1], execution(), still), 0.97 * 200 * 100);
}

TEST(StillPixels, ThresholdIsChecked) {
  EXPECT_THROW(StillPixels(-0.1), UsageError);
  EXPECT_THROW(StillPixels(256), UsageError);
  EXPECT_THROW(StillPixels(std::nan("")), UsageError);
}

TEST(LumaIntensity, AreTheSameForAllDepths) {
  const int width = 37;
  const int height = 21;
  Image<std::uint8_t> bytes(width, height, 3);
  Image<std::uint16_t> words(width, height, 3);
  Image<float> floats(width, height, 3);
  std::mt19937 random(4);
  for (const auto [k, y] : positions_of(3 * width, height)) {
    const auto level = static_cast<std::uint8_t>(random());
    bytes.row(y)[k] = level;
    words.row(y)[k] = static_cast<std::uint16_t>(level * 257);
    floats.row(y)[k] = static_cast<float>(level) / 255.0F;
  }
  Image<std::uint8_t> of_bytes;
  Image<std::uint8_t> of_words;
  Image<std::uint8_t> of_floats;
  luma_intensity({std::move(bytes)}, execution(), of_bytes);
  luma_intensity({std::move(words)}, execution(), of_words);
  luma_intensity({std::move(floats)}, execution(), of_floats);
  for (const auto [x, y] : positions_of(width, height)) {
    ASSERT_NEAR(of_bytes.at(x, y), of_floats.at(x, y), 1);
    ASSERT_NEAR(of_words.at(x, y), of_floats.at(x, y), 1);
  }
}

}  // namespace vantage::still_pixels_test
