// Costs of coarse levels in bands of rows: the same maps.
#include "engine/matching/levels/level_bands.h"

#include "engine/image/memory_use.h"
#include "engine/matching/levels/level_extents.h"
#include "engine/matching/search_table.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::level_bands_test {

constexpr int kWidth = 203;
constexpr int kHeight = 149;
constexpr DisparityRange kRange{-2, 38};

MatchOptions preset(MatchPreset of) {
  MatchOptions options;
  options.preset = of;
  options.disparities = kRange;
  return options;
}

MatchOptions method(MatchMethod of, MethodOverrides parameters) {
  MatchOptions options;
  options.method = of;
  options.disparities = kRange;
  options.parameters = std::move(parameters);
  options.parameters.levels = 5;
  if (of != MatchMethod::kSsd) {
    options.parameters.iterations = 3;
  }
  return options;
}

struct Matched {
  DisparityMaps maps;
  std::size_t level_bytes = 0;  ///< kept, or 0 where bands released it
};

/// Each map alone: together they would share costs, which are not in bands then.
Matched match(MatchOptions options, std::size_t level_bytes, int threads) {
  options.raw = true;
  const auto [left, right] = textured_pair(kWidth, kHeight, kRange, PixelKind::kGrey8, 7);
  Execution execution({.threads = threads, .level_memory_bytes = level_bytes});
  const StereoMatcher matcher(options, execution);
  Matched result;
  DisparityMaps right_alone;
  matcher.match(left, right, {.left = false, .confidence = true}, right_alone);
  matcher.match(left, right, {.right = false, .confidence = true}, result.maps);
  result.maps.right = std::move(right_alone.right);
  MemoryUse use;
  matcher.add_memory_use(use);
  for (const MemoryUse::Owner& owner : use.owners) {
    result.level_bytes += owner.name == "coarse levels" ? owner.bytes : 0;
  }
  return result;
}

TEST(LevelBands, MapsAreTheSame) {
  std::vector<MatchOptions> cases = {
      preset(MatchPreset::kBalanced),
      preset(MatchPreset::kQuality),
      method(MatchMethod::kBayes, {.prior = Prior::kQuadratic}),
      method(MatchMethod::kBayes, {.cost = MatchCost::kRayCensus,
                                   .candidate_blocks = 1,
                                   .pruned_levels = 3,
                                   .window_levels = 1,
                                   .prior_smoothing = PriorSmoothing::kMaximum}),
      method(MatchMethod::kMembrane, {.edge_weight = 0.3}),
      method(MatchMethod::kSsd, {.window_px = 7})};
  cases[0].parameters.candidate_step_px = 0.5;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Matched whole = match(cases[i], kDefaultLevelBytes, 2);
    EXPECT_GT(whole.level_bytes, 0U);
    for (const auto& [level_bytes, threads] : {std::pair<std::size_t, int>{1, 3}, {200'000, 1}}) {
      const Matched banded = match(cases[i], level_bytes, threads);
      EXPECT_TRUE(identical(banded.maps, whole.maps)) << i << " " << level_bytes;
      EXPECT_LT(banded.level_bytes, whole.level_bytes / 8) << i;
    }
  }
}

TEST(LevelBands, AreOfTheFinestLevels) {
  constexpr std::size_t kMiB = std::size_t{1} << 20;
  const auto extents = level_extents({8192, 8192}, 7);
  EXPECT_EQ(level_bands(extents, 512, 1, std::size_t{16} << 30), LevelBands{});
  EXPECT_EQ(level_bands(extents, 512, 1, 2048 * kMiB), (LevelBands{2, 128}));
  EXPECT_EQ(level_bands(extents, 512, 1, 8192 * kMiB), (LevelBands{1, 512}));
  EXPECT_EQ(level_bands(extents, 512, 1, 1), (LevelBands{5, 32}));
  EXPECT_EQ(level_bands({{100, 100}, {50, 50}}, 16, 1, 1), LevelBands{});
}

TEST(LevelBands, EstimateTellsWhatDoesNotFit) {
  const auto options = [](MatchPreset of) {
    MatchOptions of_preset = preset(of);
    of_preset.disparities = {0, 511};
    return of_preset.in_force();
  };
  constexpr std::size_t kGiB = std::size_t{1} << 30;
  const MatchSize size{.image = {8192, 8192}};
  EXPECT_EQ(memory_obstacle(options(MatchPreset::kBalanced), size, 16 * kGiB), "");
  EXPECT_EQ(memory_obstacle(options(MatchPreset::kBalanced), size, 0), "");
  EXPECT_THAT(memory_obstacle(options(MatchPreset::kBalanced), size, 6 * kGiB),
              testing::HasSubstr("8192x8192 pixels with 512 disparities need about "));
  EXPECT_EQ(memory_obstacle(options(MatchPreset::kRealtime), size, 6 * kGiB), "");
  // Along epipolar lines the other image is sampled 16 times; nothing is searched in reduced
  // images.
  EXPECT_GT(search_plan(options(MatchPreset::kRealtime), {.image = size.image, .along_lines = true})
                .bytes(),
            search_plan(options(MatchPreset::kRealtime), size).bytes() + 16 * kGiB);
  // Several images are searched at full size, too.
  const std::vector<double> baselines = {1, 0.5};
  EXPECT_THAT(memory_obstacle(options(MatchPreset::kRealtime),
                              {.image = size.image, .baselines = baselines}, 6 * kGiB),
              testing::EndsWith("of this machine: match tiles or fewer disparities"));
  // Without bands.
  EXPECT_GT(
      search_plan(options(MatchPreset::kBalanced), {.image = size.image, .level_bytes = 100 * kGiB})
          .bytes(),
      search_plan(options(MatchPreset::kBalanced), size).bytes() + 8 * kGiB);
}

}  // namespace vantage::level_bands_test
