#include "engine/io/images/scene_mask.h"

#include "engine/image/left_out.h"
#include "engine/io/images/black_border.h"
#include "engine/io/images/photograph_io.h"
#include "engine/sequence/pairs/pair_source.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/random_grey.h"

namespace vantage::scene_mask_test {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

/// Noise of 60 to 250; `level(x, y, value)` makes each pixel of it.
template <typename Level>
Photograph picture(const Level& level, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  Image<std::uint8_t> image(kWidth, kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const int value = 60 + static_cast<int>(random() % 190);
    image.at(x, y) = static_cast<std::uint8_t>(std::clamp<int>(level(x, y, value), 0, 255));
  }
  return {std::move(image)};
}

template <typename IsBorder>
void expect_found(const Photograph& photograph, const IsBorder& is_border) {
  const Mask found = black_border(photograph);
  ASSERT_FALSE(found.empty());
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    ASSERT_EQ(found.at(x, y) != 0, is_border(x, y)) << x << ", " << y;
  }
}

TEST(BlackBorder, IsFoundWhereBarsHaveTheNoiseOfCodecs) {
  const auto is_bar = [](int x, int y) { return y < 9 || y >= 111 || x < 4; };
  expect_found(
      picture([&](int x, int y, int value) { return is_bar(x, y) ? 5 + (x * 7 + y) % 3 : value; }),
      is_bar);
}

TEST(BlackBorder, IsFoundWhereARectificationLeavesWedges) {
  const auto is_wedge = [](int x, int y) {
    return x < (90 - y) / 6.0 || y > 117 - x / 20.0 || x > 158 - 0.002 * y * y;
  };
  expect_found(picture([&](int x, int y, int value) { return is_wedge(x, y) ? 0 : value; }),
               is_wedge);
}

TEST(BlackBorder, IsNotFoundInDarkScenes) {
  std::mt19937 random(5);
  std::vector<int> trees(kWidth);
  std::ranges::generate(trees, [&] { return 20 + static_cast<int>(random() % 12); });
  const auto radius = [](int x, int y) { return std::hypot(x - 80, y - 60); };
  const std::array<Photograph, 8> scenes = {
      // Clipped sky above trees, sky with noise above a roof, the end of a tunnel.
      picture([&](int x, int y, int value) {
        return y < trees[static_cast<std::size_t>(x)] ? 0 : value;
      }),
      picture([](int, int y, int value) { return y < 30 ? value % 9 : value; }),
      picture([&](int x, int y, int value) { return radius(x, y) + value % 7 > 85 ? 0 : value; }),
      // A vignette, a slope of brightness, a dark frame, a black one, a lamp.
      picture([&](int x, int y, int value) {
        return static_cast<int>(value * std::max(0.0, 1 - std::pow(radius(x, y) / 100, 3)));
      }),
      picture([](int, int y, int value) { return value * y / 120; }),
      picture([](int, int, int value) { return value % 5; }),
      picture([](int, int, int) { return 0; }),
      picture([&](int x, int y, int value) { return radius(x, y) < 9 ? value : 0; })};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    EXPECT_TRUE(black_border(scenes[i]).empty()) << i;
  }
}

TEST(SceneMask, TakesFilesAlphaAndOneColour) {
  Photograph left = picture([](int, int, int value) { return value; });
  Photograph right = picture([](int, int, int value) { return value; }, 2);
  const Photograph file = picture([](int x, int y, int) { return x < 20 && y < 30 ? 0 : 1; });
  leave_out_of_pair({}, {black_pixels(file), Mask()}, left, right);
  EXPECT_DOUBLE_EQ(share_of(left.left_out), 600.0 / (kWidth * kHeight));
  EXPECT_TRUE(right.left_out.empty());
  EXPECT_THAT(
      [&] {
        leave_out_of_pair({}, {Mask(), Mask(3, 3)}, left, right);
      },
      testing::ThrowsMessage<Error>(
          "the mask of the right image is 3x3, expected 160x120 as the image"));
  EXPECT_THROW(leave_out_of_pair({.left = "alpha"}, left, right), Error);

  Image<std::uint16_t> colours(2, 1, 4);
  const std::array<std::uint16_t, 8> values = {7, 8, 9, 1, 7, 8, 10, 0};
  std::ranges::copy(values, colours.row(0));
  const auto left_out = [&](const SceneMaskOptions& options) {
    Photograph one{colours.copy()};
    Photograph other{colours.copy()};
    leave_out_of_pair(options, one, other);
    return std::pair<int, int>(one.left_out.at(0, 0), other.left_out.at(1, 0));
  };
  EXPECT_EQ(left_out({.left = "none", .no_data = {7, 8, 9}}), std::pair(255, 0));
  EXPECT_EQ(left_out({.left = "alpha"}), std::pair(0, 255));
  EXPECT_THROW(SceneMaskOptions({.no_data = {1, 2}}).validate(), UsageError);
}

/// A folder of pairs with black bars, the first pair of which is dark.
class MaskedPairs : public testing::Test {
 protected:
  void write(const std::string& side, int frame, const Photograph& photograph) {
    const std::filesystem::path folder = folder_.path() / side;
    std::filesystem::create_directories(folder);
    write_photograph(folder / (std::to_string(frame) + ".png"), photograph);
  }
  [[nodiscard]] PairSourceOptions options(SceneMaskOptions masks) const {
    PairSourceOptions options;
    options.left = (folder_.path() / "left").string();
    options.right = (folder_.path() / "right").string();
    options.masks = std::move(masks);
    return options;
  }
  /// The share left out of the left image of a pair.
  static double share_at(PairSource& pairs, int index) {
    FramePair pair;
    pairs.skip_to(index);
    EXPECT_TRUE(pairs.fetch(pair));
    pairs.decode(pair);
    return share_of(pair.left.left_out);
  }

  TemporaryFolder folder_;
};

TEST_F(MaskedPairs, BordersAreThoseOfTheFilmWhicheverPairComesFirst) {
  for (int frame = 0; frame < 50; ++frame) {
    for (const char* const side : {"left", "right"}) {
      write(side, frame, picture([&](int, int y, int value) {
              return y < 12 || (frame == 0 && value > 70) ? 0 : value;
            }));
    }
  }
  for (const int first : {0, 3, 49}) {
    const auto pairs = open_pair_source(options({}));
    EXPECT_DOUBLE_EQ(share_at(*pairs, first), 0.1) << first;
    EXPECT_DOUBLE_EQ(share_at(*pairs, 1), 0.1);
  }
  EXPECT_EQ(share_at(*open_pair_source(options({.left = "none"})), 3), 0);
}

TEST_F(MaskedPairs, AMaskForEachFrameAndABadOne) {
  for (int frame = 0; frame < 3; ++frame) {
    const Photograph texture = picture([](int, int, int value) { return value; });
    write("left", frame, texture);
    write("right", frame, texture);
    write("mask", frame, picture([&](int x, int, int) { return x < 16 * frame ? 0 : 255; }));
  }
  write("mask", 1, Photograph{Image<std::uint8_t>(9, 9)});
  const std::string masks = (folder_.path() / "mask").string();
  const auto pairs = open_pair_source(options({.left = masks}));
  EXPECT_EQ(share_at(*pairs, 0), 0);
  EXPECT_DOUBLE_EQ(share_at(*pairs, 2), 0.2);
  EXPECT_THROW(share_at(*pairs, 1), Error);
  EXPECT_EQ(pairs->identities().size(), 3);
  const auto hidden = folder_.path() / "hidden.png";
  std::filesystem::rename(folder_.path() / "right" / "1.png", hidden);
  EXPECT_DOUBLE_EQ(share_at(*open_pair_source(options({.left = masks})), 1), 0.2) << "of frame 2";
  std::filesystem::rename(hidden, folder_.path() / "right" / "1.png");
  std::filesystem::remove(folder_.path() / "mask" / "2.png");
  EXPECT_THROW(open_pair_source(options({.left = masks})), Error);
}

}  // namespace vantage::scene_mask_test
