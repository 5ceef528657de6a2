#include "engine/sequence/shots/shot_cuts.h"

#include "tests/engine/engine_test.h"

namespace vantage::shot_cuts_test {

/// Smooth pictures: scene and place decide what is seen, 0 ≤ place.
Photograph picture(int scene, double place, double gain = 1, double offset = 0) {
  constexpr int kWidth = 160;
  constexpr int kHeight = 90;
  std::mt19937 random(static_cast<unsigned>(scene));
  double waves[6][4];
  for (auto& wave : waves) {
    for (double& value : wave) {
      value = static_cast<double>(random() % 1000) / 1000;
    }
  }
  Image<std::uint8_t> image(kWidth, kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    double level = 100;
    for (const auto& wave : waves) {
      level +=
          15 * std::sin((x + place) * (0.02 + wave[0] * 0.1) + y * wave[1] * 0.15 + 6 * wave[2]);
    }
    image.at(x, y) =
        static_cast<std::uint8_t>(std::clamp(std::lround(gain * level + offset), 0L, 255L));
  }
  return {std::move(image)};
}

std::vector<int> starts_of(int frames, const std::function<Photograph(int)>& frame) {
  ShotCuts cuts;
  for (int t = 0; t < frames; ++t) {
    cuts.add(make_thumbnail(frame(t)));
  }
  return cuts.shot_starts();
}

TEST(ShotCuts, AreBetweenScenes) {
  EXPECT_THAT(starts_of(40, [](int t) { return picture(t < 12   ? 1
                                                       : t < 25 ? 2
                                                                : 3,
                                                       t * 0.5); }),
              ElementsAre(0, 12, 25));
  // At the second and at the last frame.
  EXPECT_THAT(starts_of(9, [](int t) { return picture(t == 0  ? 1
                                                      : t < 8 ? 2
                                                              : 3,
                                                      0); }),
              ElementsAre(0, 1, 8));
  EXPECT_THAT(starts_of(2, [](int t) { return picture(t, 0); }), ElementsAre(0, 1));
}

TEST(ShotCuts, MovementIsNone) {
  EXPECT_THAT(starts_of(30, [](int t) { return picture(1, t); }), ElementsAre(0));
  // So fast that neighbours are unrelated.
  EXPECT_GT(dissimilarity(make_thumbnail(picture(1, 0)), make_thumbnail(picture(1, 60))), 0.5);
  EXPECT_THAT(starts_of(30, [](int t) { return picture(1, 60.0 * t); }), ElementsAre(0));
}

TEST(ShotCuts, FlashesAndFadesAreNone) {
  EXPECT_THAT(
      starts_of(20, [](int t) { return t == 10 ? picture(7, 0, 0.05, 230) : picture(1, t); }),
      ElementsAre(0));
  EXPECT_THAT(starts_of(20, [](int t) { return picture(1, t, t < 10 ? 1 : 0.7, t < 10 ? 0 : 60); }),
              ElementsAre(0));
  EXPECT_THAT(starts_of(21, [](int t) { return picture(1, 0, 1 - 0.05 * t); }), ElementsAre(0));
}

TEST(ShotCuts, UnknownFramesAreNone) {
  ShotCuts cuts;
  for (int t = 0; t < 20; ++t) {
    cuts.add(t == 5 || t == 6 ? std::nullopt
                              : std::optional(make_thumbnail(picture(t < 12 ? 1 : 2, 0))));
  }
  EXPECT_THAT(cuts.shot_starts(), ElementsAre(0, 12));
  EXPECT_TRUE(ShotCuts().shot_starts().empty());
}

TEST(Thumbnail, IsTheMeanOfEachPart) {
  Image<float> image(64, 48, 3);
  for (const auto [k, y] : positions_of(3 * 64, 48)) {
    image.row(y)[k] = static_cast<float>(y / 2 * 32 + k / 6) / 1000 * (y % 2 == 0 ? 1.5F : 0.5F);
  }
  const Thumbnail thumbnail = make_thumbnail({std::move(image)});
  for (int k = 0; k < 32 * 24; ++k) {
    ASSERT_NEAR(thumbnail.levels[static_cast<std::size_t>(k)], k * 0.255, 1e-3);
  }
}

TEST(Thumbnail, OfTinyPictures) {
  for (const int width : {1, 5, 33}) {
    for (const int height : {1, 3, 25}) {
      Image<std::uint8_t> image(width, height);
      image.fill(80);
      const Thumbnail thumbnail = make_thumbnail({std::move(image)});
      EXPECT_EQ(*std::min_element(thumbnail.levels.begin(), thumbnail.levels.end()), 80);
      EXPECT_EQ(dissimilarity(thumbnail, Thumbnail{}), 0) << "both without content";
    }
  }
}

}  // namespace vantage::shot_cuts_test
