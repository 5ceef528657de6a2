#include "engine/matching/pair_exposure.h"

#include "engine/io/images/photograph_io.h"
#include "engine/matching/estimation/intensity_change_fit.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/test_paths.h"

namespace vantage::pair_exposure_test {

constexpr int kWidth = 240;
constexpr DisparityRange kRange{0, 31};

/// A textured square before a textured background: x_left − x_right of both, and what no match is.
struct Scene {
  Photograph left;
  Photograph right;
  Image<int> disparity;  ///< of the left image
  Mask is_visible;       ///< not 0: in the right image
};

struct Camera {
  IntensityChange change;  ///< of true levels, to what the right camera makes of them
  double noise = 0;        ///< of the left camera; of the right one as its gain makes it
  int channels = 1;
};

/// Smooth enough that levels between pixels are near those of pixels.
std::vector<double> texture_row(std::mt19937& random, int width) {
  std::vector<double> row(static_cast<std::size_t>(width));
  double level = 100;
  for (double& value : row) {
    level = 0.8 * level + 0.2 * (30 + static_cast<double>(random() % 141));
    value = std::clamp(2.2 * (level - 100) + 100, 25.0, 175.0);
  }
  return row;
}

Scene make_scene(int height, const Camera& camera) {
  constexpr int kFar = 5;
  constexpr int kNear = 19;
  std::mt19937 random(9);
  std::normal_distribution<double> gaussian(0, 1);
  Scene scene;
  scene.disparity = Image<int>(kWidth, height);
  scene.is_visible = Mask(kWidth, height);
  Image<float> left(kWidth, height, camera.channels);
  Image<float> right(kWidth, height, camera.channels);
  const auto noisy = [&](double level, double gain) {
    return static_cast<float>((level + gain * camera.noise * gaussian(random)) / 255);
  };
  for (int y = 0; y < height; ++y) {
    const bool has_square = y > height / 4 && y < 3 * height / 4;
    for (int c = 0; c < camera.channels; ++c) {
      const std::vector<double> back = texture_row(random, kWidth + 64);
      const std::vector<double> front = texture_row(random, kWidth + 64);
      const auto is_front = [&](int x, int disparity) {
        return has_square && x + disparity >= 80 && x + disparity < 150;
      };
      for (int x = 0; x < kWidth; ++x) {
        const bool left_front = is_front(x, 0);
        const bool right_front = is_front(x, kNear);
        const int d = left_front ? kNear : kFar;
        left.at(x, y, c) = noisy(
            left_front ? front[static_cast<std::size_t>(x)] : back[static_cast<std::size_t>(x)], 1);
        const double level = right_front ? front[static_cast<std::size_t>(x + kNear)]
                                         : back[static_cast<std::size_t>(x + kFar)];
        right.at(x, y, c) =
            noisy(camera.change.gain * level + camera.change.offset, camera.change.gain);
        scene.disparity.at(x, y) = d;
        scene.is_visible.at(x, y) = x - d >= 0 && (left_front || !is_front(x - d, kNear)) ? 255 : 0;
      }
    }
  }
  scene.left = {std::move(left)};
  scene.right = {std::move(right)};
  return scene;
}

/// What turns the right camera's levels back.
IntensityChange inverse(const IntensityChange& change) {
  return {.gain = 1 / change.gain, .offset = -change.offset / change.gain};
}

void expect_near(const IntensityChange& actual, const IntensityChange& expected) {
  EXPECT_NEAR(actual.gain, expected.gain, 0.01 * expected.gain);
  constexpr double kMiddle = 100;
  EXPECT_NEAR(actual.gain * kMiddle + actual.offset, expected.gain * kMiddle + expected.offset, 1);
}

TEST(PairExposure, RecoversExposureDespiteOcclusions) {
  const PairExposureEstimator estimator(kRange, execution());
  for (const int height : {60, 400}) {
    for (const IntensityChange change : {IntensityChange{}, IntensityChange{.7, 0},
                                         IntensityChange{1.25, -11}, IntensityChange{.5, 30}}) {
      for (const double noise : {0., 3.}) {
        const Scene scene = make_scene(height, {change, noise, 1});
        const PairExposure levels =
            estimator.estimate(scene.left, scene.right, ColourUse::kLuma, true);
        ASSERT_TRUE(levels.has_intensity_change) << change.gain;
        EXPECT_GT(levels.matches, 2000);
        expect_near(levels.of_right.luma, inverse(change));
      }
    }
  }
}

TEST(PairExposure, ChannelsHaveTheirOwn) {
  Scene scene = make_scene(200, {{}, 1, 3});
  auto& right = std::get<Image<float>>(scene.right.pixels);
  const IntensityChange changes[] = {{.7, 10}, {1, 0}, {1.2, -5}};
  for (const auto [x, y] : positions_of(right)) {
    for (int c = 0; c < 3; ++c) {
      float& value = right.at(x, y, c);
      value = static_cast<float>((changes[c].gain * 255 * value + changes[c].offset) / 255);
    }
  }
  const PairExposure levels = PairExposureEstimator(kRange, execution())
                                  .estimate(scene.left, scene.right, ColourUse::kChannels, true);
  ASSERT_TRUE(levels.has_intensity_change);
  for (std::size_t c = 0; c < 3; ++c) {
    expect_near(levels.of_right.channels[c], inverse(changes[c]));
  }
}

TEST(PairExposure, NoMatchesLeaveLevelsAsTheyAre) {
  const PairExposureEstimator estimator(kRange, execution());
  Image<std::uint8_t> grey(50, 40);
  grey.fill(90);
  const Photograph uniform{std::move(grey)};
  const PairExposure of_uniform = estimator.estimate(uniform, uniform, ColourUse::kLuma, true);
  EXPECT_FALSE(of_uniform.has_intensity_change);
  EXPECT_EQ(of_uniform.of_right, IntensityChanges{});
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{40, 1}, std::pair{1, 300}}) {
    const Photograph tiny{Image<std::uint8_t>(width, height)};
    const PairExposure levels = estimator.estimate(tiny, tiny, ColourUse::kLuma, true);
    EXPECT_FALSE(levels.has_intensity_change);
  }
}

/// Birchfield and Tomasi's difference at true matches, in grey levels.
double true_sigma(const Scene& scene) {
  const auto& left = std::get<Image<float>>(scene.left.pixels);
  const auto& right = std::get<Image<float>>(scene.right.pixels);
  std::vector<double> residuals;
  const auto outside = [](float value, const Image<float>& image, int x, int y) {
    double low = 1e9;
    double high = -1e9;
    for (const int u : {-1, 0, 1}) {
      const int beside = std::clamp(x + u, 0, image.width() - 1);
      const double at = (double{image.at(x, y)} + image.at(beside, y)) / 2;
      low = std::min(low, at);
      high = std::max(high, at);
    }
    return std::max({0.0, value - high, low - value});
  };
  for (const auto [x, y] : positions_of(left)) {
    if (scene.is_visible.at(x, y) != 0) {
      const int partner = x - scene.disparity.at(x, y);
      residuals.push_back(255 * std::min(outside(left.at(x, y), right, partner, y),
                                         outside(right.at(partner, y), left, x, y)));
    }
  }
  std::ranges::sort(residuals);
  return residuals[residuals.size() * 9 / 10] / 1.6449;
}

TEST(PairExposure, NoiseIsThatOfTrueMatches) {
  const PairExposureEstimator estimator(kRange, execution());
  for (const double noise : {14., 18., 22.}) {
    const Scene scene = make_scene(300, {{}, noise, 1});
    const double expected = true_sigma(scene);
    ASSERT_GT(expected, 4);
    for (const bool changes_intensities : {false, true}) {
      const PairExposure levels =
          estimator.estimate(scene.left, scene.right, ColourUse::kLuma, changes_intensities);
      ASSERT_TRUE(levels.sigma_measurement.has_value());
      EXPECT_NEAR(*levels.sigma_measurement, expected, 0.15 * expected) << noise;
    }
  }
  const Scene clean = make_scene(300, {{}, 0, 1});
  EXPECT_EQ(estimator.estimate(clean.left, clean.right, ColourUse::kLuma, true).sigma_measurement,
            4.0);
}

TEST(PairExposure, ThreadsChangeNothing) {
  const Scene scene = make_scene(260, {{.8, 5}, 3, 3});
  Execution serial({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  Execution threads({.threads = 3});
  const auto estimate = [&](Execution& execution) {
    return PairExposureEstimator(kRange, execution)
        .estimate(scene.left, scene.right, ColourUse::kChannels, true);
  };
  EXPECT_EQ(estimate(serial), estimate(threads));
}

MatchOptions exposure_options(Side reference, MatchCost cost) {
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.disparities = kRange;
  options.reference = reference;
  options.parameters.cost = cost;
  options.parameters.subpixel = Subpixel::kNone;
  options.raw = true;
  return options;
}

double share_of_right(const DisparityMap& map, const Scene& scene) {
  int right = 0;
  int all = 0;
  for (const auto [x, y] : positions_of(map)) {
    if (scene.is_visible.at(x, y) != 0) {
      ++all;
      right += map.at(x, y) == static_cast<float>(scene.disparity.at(x, y)) ? 1 : 0;
    }
  }
  return static_cast<double>(right) / all;
}

TEST(PairExposure, MatchersSeeThroughExposure) {
  const Scene scene = make_scene(200, {{.6, 12}, 2, 1});
  for (const MatchCost cost :
       {MatchCost::kSquared, MatchCost::kAbsolute, MatchCost::kContaminated}) {
    MatchOptions options = exposure_options(Side::kLeft, cost);
    DisparityMaps maps;
    MatchReport report;
    StereoMatcher(options, execution()).match(scene.left, scene.right, {}, maps, &report);
    EXPECT_FALSE(report.exposure);
    const double without = share_of_right(maps.left.disparity_px, scene);
    options.parameters.match_exposure = true;
    if (cost == MatchCost::kContaminated) {
      options.parameters.estimate_sigma_measurement = true;
    }
    StereoMatcher(options, execution()).match(scene.left, scene.right, {}, maps, &report);
    ASSERT_TRUE(report.exposure);
    EXPECT_TRUE(report.exposure->has_intensity_change);
    const double with = share_of_right(maps.left.disparity_px, scene);
    EXPECT_GT(with, 0.9) << static_cast<int>(cost);
    EXPECT_GT(with, without) << static_cast<int>(cost);
  }
}

TEST(PairExposure, SeveralImagesAreChangedEachByItsOwn) {
  const Scene dark = make_scene(200, {{.6, 12}, 1, 1});
  const Scene bright = make_scene(200, {{1.2, -8}, 1, 1});
  MatchOptions options = exposure_options(Side::kLeft, MatchCost::kAbsolute);
  options.parameters.match_exposure = true;
  DisparityMaps maps;
  MatchReport report;
  const StereoMatcher matcher(options, execution());
  const OtherView others[] = {{&dark.right, 1}, {&bright.right, 1.0000001}};
  matcher.match_several(dark.left, others, {}, maps, &report);
  ASSERT_TRUE(report.exposure);
  expect_near(report.exposure->of_right.luma, inverse({.6, 12}));
  EXPECT_GT(share_of_right(maps.left.disparity_px, dark), 0.9);
}

TEST(PairExposure, OfAPhotographTakenWithAnotherExposure) {
  const std::filesystem::path data = test_paths::shared_data() / "motorcycle";
  if (!std::filesystem::exists(data)) {
    GTEST_SKIP() << "no photographs at " << data;
  }
  const Photograph left = read_photograph(data / "im0.png");
  const Photograph dark = read_photograph(data / "im1E.png");
  const PairExposure levels =
      PairExposureEstimator({0, 69}, execution()).estimate(left, dark, ColourUse::kLuma, true);
  ASSERT_TRUE(levels.has_intensity_change);
  // The mean levels differ by 41.
  EXPECT_GT(levels.of_right.luma.gain * 100 + levels.of_right.luma.offset, 120);
  EXPECT_LT(*levels.sigma_measurement, 9);
}

}  // namespace vantage::pair_exposure_test
