#include "engine/matching/noise/noise_estimate.h"
#include "engine/matching/noise/noise_filter.h"

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/every_execution.h"

namespace vantage::noise_test {

constexpr int kWidth = 131;
constexpr int kHeight = 98;
constexpr int kShiftPx = 5;

/// Shading, with waves of some pixels in a part of the rows.
double scene(int x, int y) {
  const double waves = y % 40 < 24 ? 25 * std::sin(0.9 * x + 0.2 * y) * std::cos(0.31 * x) : 0;
  return 120 + 0.2 * x + 0.1 * y + waves;
}

/// An image of the scene, whose left image is at 0 and whose right one at kShiftPx, with what
/// `defect(x, y)` adds.
template <typename Defect>
Photograph image_of(int shift_px, Defect defect) {
  Image<std::uint8_t> image(kWidth, kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    image.at(x, y) = static_cast<std::uint8_t>(
        std::lround(std::clamp(scene(x + shift_px, y) + defect(x, y), 0.0, 255.0)));
  }
  return {std::move(image)};
}

Photograph noisy(int shift_px, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1);
  return image_of(shift_px, [&](int, int) { return sigma * noise(random); });
}

/// Blocks of 8×8 pixels are up to 2 levels too dark or too bright, as codecs leave them.
Photograph coded(int shift_px, int x_phase, int y_phase) {
  std::mt19937 random(3);
  std::map<std::pair<int, int>, double> offsets;
  return image_of(shift_px, [&, x_phase, y_phase](int x, int y) {
    const auto [place, is_new] = offsets.try_emplace({(x + x_phase) / 8, (y + y_phase) / 8}, 0);
    if (is_new) {
      place->second = static_cast<double>(random() % 5) - 2;
    }
    return place->second;
  });
}

FoundNoise found_in(const Photograph& left, const Photograph& right,
                    std::optional<DisparityRange> range = DisparityRange{0, 15}) {
  const std::array<const Photograph*, 2> pair{&left, &right};
  return find_noise(pair, range, execution());
}

TEST(NoiseEstimate, MeasuresNoiseThatWasAdded) {
  for (const double sigma : {3.0, 6.0, 12.0}) {
    const FoundNoise found = found_in(noisy(0, sigma, 1), noisy(kShiftPx, sigma, 2));
    EXPECT_EQ(found.kind, NoiseKind::kSensor) << sigma;
    EXPECT_NEAR(found.grey_levels, sigma, 0.2 * sigma);
  }
  EXPECT_EQ(found_in(noisy(0, 0.5, 1), noisy(kShiftPx, 0.5, 2)).kind, NoiseKind::kNone);
  EXPECT_EQ(found_in(noisy(0, 6, 1), noisy(kShiftPx, 0, 2)).kind, NoiseKind::kNone);
}

TEST(NoiseEstimate, TextureThatBothImagesShowIsNotNoise) {
  const auto grain = [](int shift_px) {
    return image_of(shift_px, [shift_px](int x, int y) {
      std::mt19937 random(static_cast<unsigned>((x + shift_px) * 1009 + y));
      return std::normal_distribution<double>(0, 6)(random);
    });
  };
  EXPECT_EQ(found_in(grain(0), grain(kShiftPx)).kind, NoiseKind::kNone);
  EXPECT_EQ(found_in(grain(0), grain(kShiftPx), std::nullopt).kind, NoiseKind::kSensor);
}

TEST(NoiseEstimate, FindsBlocksWhereverTheyBegin) {
  for (const int phase : {0, 3, 7}) {
    EXPECT_EQ(found_in(coded(0, phase, 0), coded(kShiftPx, 0, phase)).kind, NoiseKind::kCodec);
  }
  EXPECT_EQ(found_in(coded(0, 0, 0), noisy(kShiftPx, 0.5, 1)).kind, NoiseKind::kNone);
}

TEST(NoiseEstimate, SmallOrBlackImagesSayNothing) {
  Image<std::uint8_t> small(63, 200);
  small.fill(9);
  EXPECT_EQ(estimate_noise({std::move(small)}, execution()).floor_grey_levels, 0);
  Image<std::uint8_t> black(80, 80);
  black.fill(0);
  EXPECT_EQ(estimate_noise({std::move(black)}, execution()).floor_grey_levels, 0);
}

struct Result {
  std::vector<double> disparities;
  std::vector<Remark> remarks;
};

Result match(const Photograph& left, const Photograph& right, std::optional<double> noise,
             Execution& with = execution(), MatchPreset preset = MatchPreset::kBalanced) {
  MatchOptions options;
  options.preset = preset;
  options.disparities = {0, 15};
  options.noise = noise;
  DisparityMaps maps;
  MatchReport report;
  StereoMatcher(options, with).match(left, right, {}, maps, &report);
  return {values_of(maps.left.disparity_px), report.remarks};
}

std::ptrdiff_t bad_pixels(const Result& result) {
  return std::ranges::count_if(result.disparities,
                               [](double d) { return std::abs(d - kShiftPx) > 1; });
}

std::ptrdiff_t noise_remarks(const Result& result) {
  return std::ranges::count(result.remarks, "noise", &Remark::subject);
}

TEST(MatchingNoise, CleanPairsAreMatchedAsTheyAre) {
  const Result found = match(noisy(0, 0.5, 1), noisy(kShiftPx, 0.5, 2), {});
  EXPECT_EQ(found.disparities, match(noisy(0, 0.5, 1), noisy(kShiftPx, 0.5, 2), 0).disparities);
  EXPECT_EQ(noise_remarks(found), 0);
}

TEST(MatchingNoise, SmoothedImagesHaveFewerBadPixels) {
  const Photograph left = noisy(0, 9, 1);
  const Photograph right = noisy(kShiftPx, 9, 2);
  for (const MatchPreset preset : {MatchPreset::kRealtime, MatchPreset::kBalanced}) {
    const Result as_is = match(left, right, 0, execution(), preset);
    const Result found = match(left, right, {}, execution(), preset);
    EXPECT_LT(bad_pixels(found), 0.9 * static_cast<double>(bad_pixels(as_is)));
    EXPECT_EQ(noise_remarks(found), 1);
    EXPECT_EQ(noise_remarks(as_is), 0);
  }
}

TEST(MatchingNoise, DoesNotDependOnTheExecution) {
  const Photograph left = noisy(0, 9, 1);
  const Photograph right = noisy(kShiftPx, 9, 2);
  expect_equal_for_every_execution(
      [&](Execution& with) { return match(left, right, {}, with).disparities; });
  expect_equal_for_every_execution([&](Execution& with) {
    return match(coded(0, 0, 0), coded(kShiftPx, 0, 0), {}, with).disparities;
  });
}

/// The mean of the definition, over pixels up to that many columns and rows away.
std::vector<double> plainly_smoothed(const std::vector<double>& grey, const NoiseFilter& filter,
                                     int columns, int rows) {
  std::vector<double> result;
  const auto at = [&](int x, int y) {
    return grey[static_cast<std::size_t>(std::clamp(y, 0, kHeight - 1) * kWidth +
                                         std::clamp(x, 0, kWidth - 1))];
  };
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    double sum = 0;
    double weights = 0;
    for (int v = -rows; v <= rows; ++v) {
      for (int u = -columns; u <= columns; ++u) {
        const double share = (at(x + u, y + v) - at(x, y)) / filter.cut_off_grey_levels;
        const double weight = std::exp(-(u * u + v * v) / (2 * std::pow(filter.sigma_px, 2))) *
                              std::pow(std::max(0.0, 1 - share * share), 2);
        sum += weight * at(x + u, y + v);
        weights += weight;
      }
    }
    result.push_back(sum / weights);
  }
  return result;
}

TEST(NoiseFilter, IsTheBilateralMeanOfItsDefinition) {
  for (const NoiseKind kind : {NoiseKind::kCodec, NoiseKind::kSensor}) {
    const NoiseFilter filter = filter_of({.kind = kind, .grey_levels = 5});
    Image<std::uint8_t> colours(kWidth, kHeight, 3);
    std::array<std::vector<double>, 3> expected;
    for (int c = 0; c < 3; ++c) {
      const Photograph channel = noisy(7 * c, 5, static_cast<unsigned>(c));
      for (const auto [x, y] : positions_of(kWidth, kHeight)) {
        const std::uint8_t grey = std::get<0>(channel.pixels).at(x, y);
        colours.at(x, y, c) = grey;
        expected[static_cast<std::size_t>(c)].push_back(grey);
      }
    }
    for (std::vector<double>& grey : expected) {
      grey = kind == NoiseKind::kCodec
                 ? plainly_smoothed(plainly_smoothed(grey, filter, 3, 0), filter, 0, 3)
                 : plainly_smoothed(grey, filter, 3, 3);
    }
    SmoothedPhotograph memory;
    const Photograph& smoothed = memory.make({std::move(colours)}, 3, filter, execution());
    const auto& pixels = std::get<Image<std::uint16_t>>(smoothed.pixels);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(pixels.at(x, y, c) / 257.0,
                    expected[static_cast<std::size_t>(c)][static_cast<std::size_t>(y * kWidth + x)],
                    0.4)
            << x << " " << y << " " << c;
      }
    }
  }
}

TEST(MatchingNoise, MethodsOfTheBookSeeImagesAsTheyAre) {
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  EXPECT_EQ(options.noise_in_force(), 0);
  options.noise = 65;
  EXPECT_EQ(error_of([&] { options.validate(); }),
            "noise is 65, expected auto, none or a number of grey levels from 0 to 64");
}

}  // namespace vantage::noise_test
