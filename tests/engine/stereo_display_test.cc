#include "engine/image/stereo_display.h"

#include "tests/engine/engine_test.h"

namespace vantage::stereo_display_test {

StereoDisplay display_of(std::string_view name) {
  const auto& names = stereo_display_names();
  const auto found =
      std::ranges::find(names, name, &std::pair<std::string_view, StereoDisplay>::first);
  EXPECT_NE(found, names.end()) << name;
  return found->second;
}

double value(const Photograph& photograph, int x, int y, int channel) {
  return std::visit([&](const auto& image) { return static_cast<double>(image.at(x, y, channel)); },
                    photograph.pixels);
}

template <typename T>
class StereoDisplayTest : public testing::Test {};
using Depths = testing::Types<std::uint8_t, std::uint16_t, float>;
TYPED_TEST_SUITE(StereoDisplayTest, Depths);

TYPED_TEST(StereoDisplayTest, RowsAndColumnsTakeTurns) {
  for (const int channels : {1, 3, 4}) {
    const Photograph left = noise<TypeParam>(13, 7, channels, 1);
    const Photograph right = noise<TypeParam>(13, 7, channels, 2);
    for (const char* name : {"irl", "irr", "icl", "icr"}) {
      const bool columns = name[1] == 'c';
      Photograph shown;
      show_stereo(left, right, display_of(name), shown);
      ASSERT_EQ(shown.width(), columns ? 26 : 13);
      ASSERT_EQ(shown.height(), columns ? 7 : 14);
      for (const auto [x, y] : positions_of(shown)) {
        const bool is_first = (columns ? x : y) % 2 == 0;
        const Photograph& source = is_first == (name[2] == 'l') ? left : right;
        for (int c = 0; c < channels; ++c) {
          ASSERT_EQ(value(shown, x, y, c),
                    value(source, columns ? x / 2 : x, columns ? y : y / 2, c))
              << name << ' ' << x << ' ' << y;
        }
      }
    }
  }
}

TYPED_TEST(StereoDisplayTest, PackingsAreThoseOfPackStereo) {
  const Photograph left = noise<TypeParam>(6, 4, 3, 1);
  const Photograph right = noise<TypeParam>(6, 4, 3, 2);
  for (const auto& [name, packing] : stereo_packing_names()) {
    if (packing.layout == StereoLayout::kFrames) {
      continue;
    }
    Photograph shown;
    Photograph packed;
    show_stereo(left, right, display_of(name), shown);
    pack_stereo(left, right, packing, packed);
    EXPECT_TRUE(same(shown, packed)) << name;
  }
}

TYPED_TEST(StereoDisplayTest, AnaglyphsOfOneGreyPictureStayAboutGrey) {
  // Through either filter a grey pixel looks as it is: rows sum to about 1 over both images.
  constexpr double kLargest = std::is_same_v<TypeParam, float>           ? 1
                              : std::is_same_v<TypeParam, std::uint16_t> ? 65535
                                                                         : 255;
  Image<TypeParam> grey(3, 2, 1);
  grey.fill(static_cast<TypeParam>(kLargest / 2));
  const Photograph left{grey.copy()};
  const Photograph right{grey.copy()};
  for (const char* name : {"arcd", "agmd", "aybd"}) {
    Photograph shown;
    show_stereo(left, right, display_of(name), shown);
    ASSERT_EQ(shown.channels(), 3);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(value(shown, 2, 1, c), kLargest / 2, 0.005 * kLargest) << name << ' ' << c;
    }
  }
}

// Values of ffmpeg 5.1, stereo3d=sbsl:NAME, for 8-bit RGB; it truncates 16-bit fractions.
TEST(StereoDisplay, AnaglyphsAreThoseOfDubois) {
  Image<std::uint8_t> left(1, 1, 3);
  Image<std::uint8_t> right(1, 1, 3);
  left.at(0, 0, 0) = 200;
  left.at(0, 0, 1) = 120;
  left.at(0, 0, 2) = 40;
  right.at(0, 0, 0) = 30;
  right.at(0, 0, 1) = 90;
  right.at(0, 0, 2) = 180;
  const struct {
    const char* name;
    int rgb[3];
  } expected[] = {{"arcd", {148, 60, 202}}, {"agmd", {50, 129, 170}}, {"aybd", {185, 109, 155}}};
  for (const auto& [name, rgb] : expected) {
    Photograph shown;
    show_stereo({left.copy()}, {right.copy()}, display_of(name), shown);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(value(shown, 0, 0, c), rgb[c], 1) << name << ' ' << c;
    }
  }
}

TEST(StereoDisplay, UnequalShapesAreRefused) {
  Photograph shown;
  for (const auto& [name, display] : stereo_display_names()) {
    EXPECT_THROW(show_stereo(noise<std::uint8_t>(4, 4, 1, 1), noise<std::uint8_t>(4, 6, 1, 1),
                             display, shown),
                 Error)
        << name;
  }
}

}  // namespace vantage::stereo_display_test
