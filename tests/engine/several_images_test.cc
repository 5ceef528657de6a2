#include "engine/matching/stereo_matcher.h"

#include "tests/engine/engine_test.h"

namespace vantage::several_images_test {

constexpr int kWidth = 160;
constexpr int kHeight = 96;
constexpr int kBackgroundPx = 4;
constexpr int kForegroundPx = 12;
constexpr int kFirst = 64;  ///< columns and rows of a square in front of the reference camera
constexpr int kEnd = 112;
constexpr int kTop = 24;
constexpr int kBottom = 72;

class Scene {
 public:
  Scene() {
    std::mt19937 random(7);
    for (auto& texture : textures_) {
      texture.resize(std::size_t{kHeight} * (kWidth + 2 * kMargin));
      std::ranges::generate(texture, [&] { return static_cast<std::uint8_t>(random() % 256); });
    }
  }

  /// What a camera sees that is `place` distances of the first other camera to the right.
  [[nodiscard]] Photograph seen_from(double place) const {
    Image<std::uint8_t> image(kWidth, kHeight);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      const int in_front = x + shift(kForegroundPx, place);
      const bool is_square = in_front >= kFirst && in_front < kEnd && y >= kTop && y < kBottom;
      image.at(x, y) =
          is_square ? texel(0, in_front, y) : texel(1, x + shift(kBackgroundPx, place), y);
    }
    return {std::move(image)};
  }

 private:
  static constexpr int kMargin = 64;

  static int shift(int disparity_px, double place) {
    return static_cast<int>(std::lround(disparity_px * place));
  }
  [[nodiscard]] std::uint8_t texel(std::size_t texture, int x, int y) const {
    const int index = y * (kWidth + 2 * kMargin) + x + kMargin;
    return textures_[texture][static_cast<std::size_t>(index)];
  }

  std::array<std::vector<std::uint8_t>, 2> textures_;
};

/// Share of unmatched pixels in these columns beside the square, away from its corners.
double unmatched_share(const MatchedMap& map, int first_column, int end_column) {
  int unmatched = 0;
  constexpr int kInset = 4;
  for (const auto [x, y] :
       positions_of({first_column, end_column}, {kTop + kInset, kBottom - kInset})) {
    unmatched += map.unmatched.at(x, y) != 0 ? 1 : 0;
  }
  return static_cast<double>(unmatched) /
         ((kBottom - kTop - 2 * kInset) * (end_column - first_column));
}

MatchedMap map_of(const MatchOptions& options, const std::vector<double>& places) {
  const Scene scene;
  const Photograph reference = scene.seen_from(0);
  std::vector<Photograph> photographs;
  std::vector<OtherView> others;
  photographs.reserve(places.size());
  for (const double place : places) {
    photographs.push_back(scene.seen_from(place));
    others.push_back({&photographs.back(), place});
  }
  DisparityMaps maps;
  StereoMatcher(options, execution()).match_several(reference, others, {}, maps);
  return std::move(maps.left);
}

MatchOptions options_of(MatchPreset preset) {
  MatchOptions options;
  options.preset = preset;
  options.disparities = {0, 15};
  return options;
}

// Left of the square 8 columns of the background are hidden from a camera at 1, 4 from one at ½.
TEST(SeveralImages, PixelsThatNoImageShowsAreUnmatched) {
  for (const MatchPreset preset : {MatchPreset::kRealtime, MatchPreset::kBalanced}) {
    const MatchedMap map = map_of(options_of(preset), {1, 0.5});
    EXPECT_GT(unmatched_share(map, kFirst - 4, kFirst), 0.7);
    EXPECT_LT(unmatched_share(map, kFirst - 8, kFirst - 4), 0.4);
    EXPECT_LT(unmatched_share(map, kFirst + 4, kEnd - 4), 0.02);
    EXPECT_LT(unmatched_share(map, kEnd + 4, kWidth - 4), 0.05);
  }
}

TEST(SeveralImages, PixelsThatOneSideShowsAreMatched) {
  for (const MatchPreset preset : {MatchPreset::kRealtime, MatchPreset::kBalanced}) {
    const MatchedMap map = map_of(options_of(preset), {1, -1});
    EXPECT_LT(unmatched_share(map, kFirst - 8, kFirst), 0.15);
    EXPECT_LT(unmatched_share(map, kEnd, kEnd + 8), 0.15);
  }
}

TEST(SeveralImages, NothingIsComparedWithoutACrossCheck) {
  MatchOptions options = options_of(MatchPreset::kBalanced);
  options.refinement.cross_check = false;
  options.refinement.speckle_size_px = 0;
  EXPECT_EQ(unmatched_share(map_of(options, {1, 0.5}), kFirst - 8, kFirst), 0);
}

TEST(SeveralImages, WhatIsHiddenTakesTheBackground) {
  const MatchedMap map = map_of(options_of(MatchPreset::kBalanced), {1, 0.5});
  EXPECT_NEAR(map.disparity_px.at(kFirst + 20, kTop + 20), kForegroundPx, 0.1);
  EXPECT_NEAR(map.disparity_px.at(kFirst - 3, kTop + 20), kBackgroundPx, 0.5);
}

}  // namespace vantage::several_images_test
