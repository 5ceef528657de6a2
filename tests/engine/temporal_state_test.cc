#include "engine/sequence/past/temporal_state.h"

#include "engine/generation/portable_random.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::temporal_state_test {

constexpr int kWidth = 67;
constexpr int kHeight = 35;

Photograph copy_of(const Photograph& photograph) {
  return {std::get<Image<std::uint8_t>>(photograph.pixels).copy()};
}

/// A map of different values with some pixels filled.
DisparityMaps some_maps(int width = kWidth, int height = kHeight) {
  DisparityMaps maps;
  for (DisparityMap* map : {&maps.left.disparity_px, &maps.right.disparity_px}) {
    map->resize(width, height);
  }
  for (Mask* mask : {&maps.left.unmatched, &maps.right.unmatched}) {
    mask->resize(width, height);
  }
  for (const auto [x, y] : positions_of(width, height)) {
    maps.left.disparity_px.at(x, y) = static_cast<float>(x) + 0.25F;
    maps.right.disparity_px.at(x, y) = static_cast<float>(y) + 0.5F;
    maps.left.unmatched.at(x, y) = (x + y) % 7 == 0 ? 255 : 0;
    maps.right.unmatched.at(x, y) = (x + 2 * y) % 5 == 0 ? 255 : 0;
  }
  return maps;
}

class TemporalStateTest : public ::testing::Test {
 protected:
  TemporalStateTest() {
    auto pair = textured_pair(kWidth, kHeight, {0, 9}, PixelKind::kGrey8, 5);
    left_ = std::move(pair.left);
    right_ = std::move(pair.right);
  }
  Execution execution_{{.threads = 2}};
  Photograph left_;
  Photograph right_;
  DisparityMaps maps_ = some_maps();
  TemporalState state_{{.weight = 0.5}};
};

TEST_F(TemporalStateTest, HandsOnMatchedPixelsOfWhatDidNotChange) {
  EXPECT_TRUE(state_.priors_for(left_, right_, execution_).empty());
  state_.remember(left_, right_, maps_, execution_);
  // The left image changes around (30, 20), the right one nowhere.
  Photograph next = copy_of(left_);
  auto& level = std::get<Image<std::uint8_t>>(next.pixels).at(30, 20);
  level = static_cast<std::uint8_t>(level + 128);
  const DisparityPrior prior = state_.priors_for(next, right_, execution_);
  EXPECT_EQ(prior.weight, 0.5);
  ASSERT_FALSE(prior.left_px.empty());
  ASSERT_FALSE(prior.right_px.empty());
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const bool left_changed = std::abs(x - 30) <= 2 && std::abs(y - 20) <= 2;
    if (left_changed || maps_.left.unmatched.at(x, y) != 0) {
      ASSERT_TRUE(std::isnan(prior.left_px.at(x, y))) << x << ", " << y;
    } else {
      ASSERT_EQ(prior.left_px.at(x, y), maps_.left.disparity_px.at(x, y)) << x << ", " << y;
    }
    if (maps_.right.unmatched.at(x, y) != 0) {
      ASSERT_TRUE(std::isnan(prior.right_px.at(x, y)));
    } else {
      ASSERT_EQ(prior.right_px.at(x, y), maps_.right.disparity_px.at(x, y));
    }
  }
}

TEST_F(TemporalStateTest, ComparesWithTheFrameJustBefore) {
  Photograph brighter = copy_of(left_);
  auto& levels = std::get<Image<std::uint8_t>>(brighter.pixels);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    levels.at(x, y) = static_cast<std::uint8_t>(levels.at(x, y) ^ 64U);
  }
  state_.remember(left_, right_, maps_, execution_);
  EXPECT_TRUE(state_.priors_for(brighter, right_, execution_).left_px.empty()) << "a cut";
  state_.remember(brighter, right_, maps_, execution_);
  const DisparityPrior prior = state_.priors_for(brighter, right_, execution_);
  ASSERT_FALSE(prior.left_px.empty());
  EXPECT_EQ(prior.left_px.at(1, 0), maps_.left.disparity_px.at(1, 0));
}

TEST_F(TemporalStateTest, HasNothingAtTheBeginning) {
  state_.remember(left_, right_, maps_, execution_);
  state_.restart();
  EXPECT_TRUE(state_.priors_for(left_, right_, execution_).empty());
  state_.remember(left_, right_, maps_, execution_);
  EXPECT_FALSE(state_.priors_for(left_, right_, execution_).empty());
}

TEST_F(TemporalStateTest, OtherSizesHaveNothingInCommon) {
  state_.remember(left_, right_, maps_, execution_);
  const auto small = textured_pair(31, 17, {0, 9}, PixelKind::kGrey8, 5);
  EXPECT_TRUE(state_.priors_for(small.left, small.right, execution_).empty());
  state_.remember(small.left, small.right, some_maps(31, 17), execution_);
  EXPECT_FALSE(state_.priors_for(small.left, small.right, execution_).empty());
}

TEST_F(TemporalStateTest, AMapThatWasNotMadeIsNoPrior) {
  maps_.right.disparity_px.resize(0, 0);
  state_.remember(left_, right_, maps_, execution_);
  const DisparityPrior prior = state_.priors_for(left_, right_, execution_);
  EXPECT_FALSE(prior.left_px.empty());
  EXPECT_TRUE(prior.right_px.empty());
}

TEST_F(TemporalStateTest, KeepsItsMemory) {
  state_.remember(left_, right_, maps_, execution_);
  state_.priors_for(left_, right_, execution_);
  state_.remember(left_, right_, maps_, execution_);
  const float* memory = state_.priors_for(left_, right_, execution_).left_px.data();
  for (int frame = 0; frame < 3; ++frame) {
    state_.remember(left_, right_, maps_, execution_);
    EXPECT_EQ(state_.priors_for(left_, right_, execution_).left_px.data(), memory);
  }
}

TEST_F(TemporalStateTest, WithoutWeightThereIsNone) {
  TemporalState state({.weight = 0});
  state.remember(left_, right_, maps_, execution_);
  EXPECT_TRUE(state.priors_for(left_, right_, execution_).empty());
}

TEST_F(TemporalStateTest, OptionsAreChecked) {
  EXPECT_THROW(TemporalState({.weight = -1}), UsageError);
  EXPECT_THROW(TemporalState({.weight = 101}), UsageError);
  EXPECT_THROW(TemporalState({.weight = std::nan("")}), UsageError);
  EXPECT_THROW(TemporalState({.weight = 1, .threshold = -1}), UsageError);
  EXPECT_THROW(TemporalState({.weight = 1, .threshold = 256}), UsageError);
}

/// What changes from frame to frame in a still scene seen with noise, in pixels of disparity.
double mean_change_px(MatchMethod method, double weight) {
  constexpr int kFrames = 8;
  const auto pair = textured_pair(90, 60, {0, 15}, PixelKind::kGrey8, 6);
  MatchOptions options;
  options.method = method;
  options.disparities = {0, 15};
  const StereoMatcher matcher(options, execution());
  TemporalState state({.weight = weight});
  DisparityMaps maps;
  DisparityMap before;
  double change = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    Photograph noisy[2] = {copy_of(pair.left), copy_of(pair.right)};
    PortableRandom random(7, static_cast<std::uint64_t>(frame));
    for (Photograph& photograph : noisy) {
      auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
      for (const auto [x, y] : positions_of(image)) {
        // Little contrast, much noise.
        image.at(x, y) = static_cast<std::uint8_t>(
            std::lround(image.at(x, y) / 16 + 100 + 1.5 * random.normal()));
      }
    }
    const MatchRequest request{.prior = state.priors_for(noisy[0], noisy[1], execution())};
    matcher.match(noisy[0], noisy[1], request, maps);
    state.remember(noisy[0], noisy[1], maps, execution());
    for (int y = 0; frame > 0 && y < 60; ++y) {
      for (int x = 20; x < 70; ++x) {
        change += std::abs(maps.left.disparity_px.at(x, y) - before.at(x, y));
      }
    }
    before = maps.left.disparity_px.copy();
  }
  return change / (50.0 * 60 * (kFrames - 1));
}

TEST(TemporalPrior, KeepsAStillNoisySceneSteady) {
  for (const MatchMethod method :
       {MatchMethod::kSsd, MatchMethod::kMembrane, MatchMethod::kBayes, MatchMethod::kGradient}) {
    const double without = mean_change_px(method, 0);
    const double with = mean_change_px(method, 1);
    EXPECT_GT(without, 0) << static_cast<int>(method);
    EXPECT_LT(with, 0.7 * without) << static_cast<int>(method);
  }
}

}  // namespace vantage::temporal_state_test
