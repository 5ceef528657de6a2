#include "engine/matching/range_estimation.h"

#include "engine/generation/book_pairs.h"
#include "engine/generation/layered_scene.h"
#include "engine/generation/portable_random.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/test_paths.h"

namespace vantage::disparity_range_test {

struct Judged {
  double covered = 0;  ///< share of the known disparities inside the range
  double ratio = 0;    ///< length of the range over that of the truth
};

Judged judge(DisparityRange range, const DisparityMap& truth) {
  float min = std::numeric_limits<float>::infinity();
  float max = -min;
  int inside = 0;
  int known = 0;
  for (const auto [x, y] : positions_of(truth)) {
    const float d = truth.at(x, y);
    if (std::isfinite(d)) {
      ++known;
      inside += d >= static_cast<float>(range.min) && d <= static_cast<float>(range.max) ? 1 : 0;
      min = std::min(min, d);
      max = std::max(max, d);
    }
  }
  return {static_cast<double>(inside) / known, range.count() / (max - min + 1.0)};
}

/// A pair of texture whose disparities are `disparity` and one more.
BookPair flat_pair(int width, int height, int disparity, BookPattern pattern) {
  // The front is one pixel nearer.
  BookPairOptions options;
  options.pattern = pattern;
  options.width_px = width;
  options.height_px = height;
  options.background_disparity_px = disparity;
  options.front_disparity_px = disparity + 1;
  return make_book_pair(options);
}

TEST(DisparityRange, CoversMadeUpScenes) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    LayeredSceneOptions options;
    options.width_px = 320;
    options.height_px = 200;
    options.far_disparity_px = 6.0 + static_cast<double>(seed);
    options.near_disparity_px = 30;
    options.samples_per_side = 1;
    options.right_gain = 1.1;
    options.right_offset = -8;
    options.noise_sigma = 2;
    options.seed = seed;
    const LayeredScene scene(options, execution());
    const SceneRendering left = scene.render({0, 0}, 0);
    const SceneRendering right = scene.render({1, 0}, 0);
    const DisparityRange range = estimate_disparity_range(left.image, right.image, execution());
    const Judged judged = judge(range, left.disparity);
    EXPECT_GE(judged.covered, 0.99) << range.min << ':' << range.max;
    EXPECT_LE(judged.ratio, 2.2) << range.min << ':' << range.max;
  }
}

TEST(DisparityRange, CoversTheBookPairsWithTexture) {
  for (const char* name : {"rds-square", "real-square", "rds-bars", "real-bars"}) {
    for (const double noise : {0.0, 4.0}) {
      BookPairOptions options = book_pair_options(name);
      options.width_px = 200;
      options.height_px = 160;
      options.noise_sigma = noise;
      const BookPair pair = make_book_pair(options);
      const DisparityRange range = estimate_disparity_range(pair.left, pair.right, execution());
      EXPECT_GE(judge(range, pair.left_disparity).covered, 0.95)
          << name << ' ' << range.min << ':' << range.max;
      EXPECT_GE(range.min, -10);
      EXPECT_LE(range.max, 30);
    }
  }
}

TEST(DisparityRange, CoversPhotographs) {
  const std::filesystem::path data = test_paths::shared_data();
  if (!std::filesystem::exists(data)) {
    GTEST_SKIP() << "no photographs at " << data;
  }
  struct Scene {
    const char* left;
    const char* right;
    const char* truth;
    double scale;
  };
  for (const Scene& scene :
       {Scene{"tsukuba/im3.ppm", "tsukuba/im4.ppm", "tsukuba/disp3.pgm", 16},
        Scene{"venus/im2.ppm", "venus/im6.ppm", "venus/disp2.pgm", 8},
        Scene{"cones/im2.png", "cones/im6.png", "cones/disp2.png", 4},
        Scene{"bowling1/view1.png", "bowling1/view5.png", "bowling1/disp1.png", 2},
        Scene{"motorcycle/im0.png", "motorcycle/im1E.png", "motorcycle/disp0.pfm", 0}}) {
    const DisparityRange range = estimate_disparity_range(
        read_photograph(data / scene.left), read_photograph(data / scene.right), execution());
    const Judged judged = judge(range, read_disparity(data / scene.truth, scene.scale));
    EXPECT_GE(judged.covered, 0.99) << scene.left << ' ' << range.min << ':' << range.max;
    EXPECT_LE(judged.ratio, 2.6) << scene.left << ' ' << range.min << ':' << range.max;
  }
}

TEST(DisparityRange, FindsNegativeAndLargeDisparities) {
  for (const int disparity : {-20, -7, 0, 31, 60}) {
    const BookPair pair = flat_pair(240, 64, disparity, BookPattern::kRandomDots);
    const DisparityRange range = estimate_disparity_range(pair.left, pair.right, execution());
    EXPECT_GE(disparity, range.min);
    EXPECT_LE(disparity + 1, range.max);
    EXPECT_LE(range.count(), 14) << range.min << ':' << range.max;
  }
}

TEST(DisparityRange, FindsASmallObjectFarBeforeTheBackground) {
  BookPairOptions options;
  options.width_px = 240;
  options.height_px = 160;
  options.front_disparity_px = 75;
  const BookPair pair = make_book_pair(options);
  const DisparityRange range = estimate_disparity_range(pair.left, pair.right, execution());
  EXPECT_LE(range.min, 2);
  EXPECT_GE(range.max, 75);
}

TEST(DisparityRange, BeginsNearerToZeroWherePartsOfTheImagesShowNothing) {
  const BookPair pair = flat_pair(320, 160, 40, BookPattern::kRandomDots);
  const DisparityRange all = estimate_disparity_range(pair.left, pair.right, execution());
  EXPECT_GE(all.min, 34);
  int last_min = all.min;
  for (const int rows : {80, 120}) {
    BookPair below_sky = flat_pair(320, 160, 40, BookPattern::kRandomDots);
    for (Photograph* photograph : {&below_sky.left, &below_sky.right}) {
      auto& image = std::get<Image<std::uint8_t>>(photograph->pixels);
      for (const auto [x, y] : positions_of({0, image.width()}, {0, rows})) {
        image.at(x, y) = 200;
      }
    }
    const DisparityRange range =
        estimate_disparity_range(below_sky.left, below_sky.right, execution());
    EXPECT_LT(range.min, last_min - 5) << rows;
    EXPECT_GE(range.min, 0) << rows;
    EXPECT_LE(range.max, all.max + 4) << rows;
    last_min = range.min;
  }
}

TEST(DisparityRange, IgnoresWhatTheOtherImageDoesNotConfirm) {
  BookPair pair = flat_pair(320, 96, 4, BookPattern::kRandomDots);
  // A piece of the right image that the left one shows a second time, 100 columns away.
  auto& left = std::get<Image<std::uint8_t>>(pair.left.pixels);
  const auto& right = std::get<Image<std::uint8_t>>(pair.right.pixels);
  for (const auto [x, y] : positions_of({224, 288}, {32, 64})) {
    left.at(x, y) = right.at(x - 100, y);
  }
  const DisparityRange range = estimate_disparity_range(pair.left, pair.right, execution());
  EXPECT_LE(range.min, 4);
  EXPECT_GE(range.max, 5);
  EXPECT_LT(range.max, 100);
}

/// The range of a pair of disparities 8..22 with independent noise, where `level(x, y)` replaces
/// grey levels: of a surface at disparity 15, x in the left image.
template <typename Level>
DisparityRange range_of_changed(double noise_sigma, const Level& level) {
  BookPairOptions options = book_pair_options("real-square");
  options.width_px = 400;
  options.height_px = 200;
  options.background_disparity_px = 8;
  options.front_disparity_px = 22;
  BookPair pair = make_book_pair(options);
  PortableRandom random(1);
  for (Photograph* const photograph : {&pair.left, &pair.right}) {
    auto& pixels = std::get<Image<std::uint8_t>>(photograph->pixels);
    const int shift = photograph == &pair.left ? 0 : 15;
    for (const auto [x, y] : positions_of(options.width_px, options.height_px)) {
      const double grey = level(x + shift, y).value_or(pixels.at(x, y));
      pixels.at(x, y) = static_cast<std::uint8_t>(
          std::clamp(std::lround(grey + noise_sigma * random.normal()), 0L, 255L));
    }
  }
  return estimate_disparity_range(pair.left, pair.right, execution());
}

TEST(DisparityRange, SkyOfNoiseDoesNotCount) {
  for (const int sigma : {1, 3}) {
    const DisparityRange range = range_of_changed(
        sigma, [](int, int y) { return y < 60 ? std::optional<int>(215 - y / 4) : std::nullopt; });
    EXPECT_LE(range.min, 8) << range.min << ':' << range.max;
    EXPECT_GE(range.max, 22);
    EXPECT_LE(range.count(), 1.6 * 14 + 16) << range.min << ':' << range.max;
  }
}

TEST(DisparityRange, BarsOfEqualDistanceDoNotCountSeveralTimes) {
  const DisparityRange range = range_of_changed(
      1, [](int x, int) { return x % 40 < 8 ? std::optional<int>(40) : std::nullopt; });
  EXPECT_LE(range.min, 8) << range.min << ':' << range.max;
  EXPECT_GE(range.max, 22);
  EXPECT_LE(range.count(), 1.6 * 14 + 16) << range.min << ':' << range.max;
}

TEST(DisparityRange, RepeatedTextureIsNoEvidence) {
  Photograph views[2];
  for (unsigned view = 0; view < 2; ++view) {
    Photograph view_noise = noise<std::uint8_t>(320, 96, 1, view + 1);
    auto& pixels = std::get<Image<std::uint8_t>>(view_noise.pixels);
    for (const auto [x, y] : positions_of(320, 96)) {
      const int stripe = x % 8 < 4 ? 60 : 180;
      pixels.at(x, y) = static_cast<std::uint8_t>(stripe + pixels.at(x, y) / 32);
    }
    views[view] = std::move(view_noise);
  }
  EXPECT_THAT(test::error_of([&] { estimate_disparity_range(views[0], views[1], execution()); }),
              HasSubstr("no disparity range can be estimated"));
}

TEST(DisparityRange, ReducesLargeImages) {
  const BookPair pair = flat_pair(2001, 97, 90, BookPattern::kGrass);
  const DisparityRange range = estimate_disparity_range(pair.left, pair.right, execution());
  EXPECT_GE(90, range.min);
  EXPECT_LE(91, range.max);
  EXPECT_LE(range.count(), 30);
}

TEST(DisparityRange, WorksOnImagesOfOneTile) {
  const BookPair pair = flat_pair(40, 12, 3, BookPattern::kRandomDots);
  const DisparityRange range = estimate_disparity_range(pair.left, pair.right, execution());
  EXPECT_GE(3, range.min);
  EXPECT_LE(3, range.max);
}

TEST(DisparityRange, IsIdenticalForAnyThreads) {
  const BookPair pair = flat_pair(150, 90, 11, BookPattern::kGrass);
  Execution one({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  Execution three({.threads = 3});
  EXPECT_EQ(estimate_disparity_range(pair.left, pair.right, one),
            estimate_disparity_range(pair.left, pair.right, three));
}

TEST(DisparityRange, SaysThatThereIsNoEvidence) {
  Image<std::uint8_t> grey(100, 60);
  grey.fill(128);
  const Photograph constant{std::move(grey)};
  const auto error_of = [&](const Photograph& left, const Photograph& right) {
    return test::error_of([&] { estimate_disparity_range(left, right, execution()); });
  };
  EXPECT_THAT(error_of(constant, constant), HasSubstr("no disparity range can be estimated"));
  EXPECT_THAT(error_of(constant, constant), HasSubstr("`disparities` MIN:MAX"));
  EXPECT_THAT(error_of(noise<std::uint8_t>(200, 100, 1, 1), noise<std::uint8_t>(200, 100, 1, 2)),
              HasSubstr("no disparity range can be estimated"));
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {2, 2}}) {
    EXPECT_THAT(error_of(noise<std::uint8_t>(width, height, 1, 1),
                         noise<std::uint8_t>(width, height, 1, 2)),
                HasSubstr("no disparity range can be estimated"));
  }
  EXPECT_THAT(error_of(constant, noise<std::uint8_t>(100, 61, 1)),
              HasSubstr("expected equal sizes"));
  EXPECT_THAT(error_of(noise<std::uint8_t>(4000, 3, 1), noise<std::uint8_t>(1, 1, 1)),
              HasSubstr("expected equal sizes"));
}

TEST(DisparityRange, MatchersRefuseWhatIsNotYetChosen) {
  MatchOptions options;
  options.disparities_auto = true;
  EXPECT_THAT(test::error_of([&] { const StereoMatcher matcher(options, execution()); }),
              HasSubstr("disparities is auto"));
  options.disparities_auto = false;
  options.disparities_y = {0, 0};
  options.disparities_y_auto = true;
  EXPECT_THAT(test::error_of([&] { const StereoMatcher matcher(options, execution()); }),
              HasSubstr("disparities is auto"));
}

}  // namespace vantage::disparity_range_test
