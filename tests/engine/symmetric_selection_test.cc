// Selection in symmetric disparity space (§3.17): both maps are of one solution, whichever image is
// which.

#include "engine/generation/book_pairs.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/option_complaint.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::symmetric_selection_test {

constexpr int kWidth = 56;  // whole blocks on every level, which mirrored images share
constexpr int kHeight = 17;

Photograph mirrored(const Photograph& photograph) {
  const auto& grey = std::get<Image<std::uint8_t>>(photograph.pixels);
  Image<std::uint8_t> result(grey.width(), grey.height());
  for (int y = 0; y < grey.height(); ++y) {
    std::reverse_copy(grey.row(y), grey.row(y) + grey.width(), result.row(y));
  }
  return {std::move(result)};
}

bool is_equal(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

class SymmetricSelection : public ::testing::TestWithParam<int> {
 protected:
  static const MethodCase& method() {
    static const auto cases = method_cases({-3, 14});
    return cases[static_cast<std::size_t>(GetParam())];
  }
  static MatchOptions options() {
    MatchOptions options = method().options;
    options.parameters.selection = Selection::kSymmetric;
    // So much noise in so small images leaves little that is worth a match with less.
    options.parameters.occlusion_penalty = 3 * options.resolved().occlusion_penalty;
    return options;
  }
};

TEST_P(SymmetricSelection, MapsAgreeAndMatchOneToOne) {
  const auto pair = textured_pair(kWidth, kHeight, {-3, 14}, PixelKind::kGrey8, 21);
  MatchOptions options = this->options();
  const DisparityMaps whole = maps_of(pair, options);
  options.parameters.subpixel = Subpixel::kParabola;
  const DisparityMaps maps = maps_of(pair, options);
  int matched = 0;
  for (int y = 0; y < kHeight; ++y) {
    int of_row = 0;
    int last = -1;
    for (int x = 0; x < kWidth; ++x) {
      const float whole_px = whole.left.disparity_px.at(x, y);
      EXPECT_EQ(whole.left.unmatched.at(x, y) != 0, std::isnan(whole_px));
      if (std::isnan(whole_px)) {
        continue;
      }
      const int right = x - static_cast<int>(whole_px);
      ASSERT_GT(right, last) << x << ", " << y;  // one to one, in order
      ASSERT_LT(right, kWidth);
      last = right;
      ++of_row;
      EXPECT_EQ(whole.right.disparity_px.at(right, y), whole_px);
      EXPECT_EQ(maps.right.disparity_px.at(right, y), maps.left.disparity_px.at(x, y));
      EXPECT_LE(std::abs(maps.left.disparity_px.at(x, y) - whole_px), 0.5F);
    }
    for (int x = 0; x < kWidth; ++x) {
      of_row -= std::isnan(maps.right.disparity_px.at(x, y)) ? 0 : 1;
      EXPECT_EQ(maps.right.unmatched.at(x, y) != 0, std::isnan(maps.right.disparity_px.at(x, y)));
    }
    EXPECT_EQ(of_row, 0) << y;
    matched += kWidth - static_cast<int>(std::count_if(whole.left.disparity_px.row(y),
                                                       whole.left.disparity_px.row(y) + kWidth,
                                                       [](float d) { return std::isnan(d); }));
  }
  EXPECT_GT(matched, kWidth * kHeight / 3);
}

/// Exchanged images, each mirrored, give exchanged and mirrored maps: exactly where aggregation is
/// in integers, else but for rounding.
TEST_P(SymmetricSelection, ExchangedImagesGiveExchangedMaps) {
  const auto pair = textured_pair(kWidth, kHeight, {-3, 14}, PixelKind::kGrey8, 22);
  MatchOptions options = this->options();
  options.parameters.subpixel = Subpixel::kParabola;
  const DisparityMaps maps = maps_of(pair, options);
  const DisparityMaps exchanged = maps_of({mirrored(pair.right), mirrored(pair.left)}, options);
  const MethodParameters parameters = options.resolved();
  const bool is_exact =
      (parameters.aggregation == Aggregation::kBox && parameters.levels == 1 &&
       (parameters.cost == MatchCost::kSquared || parameters.cost == MatchCost::kCensus)) ||
      parameters.aggregation == Aggregation::kNone ||
      parameters.prior_smoothing == PriorSmoothing::kMaximum;
  int different = 0;
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const int other = kWidth - 1 - x;
    for (const auto& [one, two] :
         {std::pair(&maps.left, &exchanged.right), std::pair(&maps.right, &exchanged.left)}) {
      const float a = one->disparity_px.at(x, y);
      const float b = two->disparity_px.at(other, y);
      if (is_exact) {
        EXPECT_TRUE(is_equal(a, b)) << x << ", " << y << ": " << a << " and " << b;
        EXPECT_TRUE(is_equal(one->confidence.at(x, y), two->confidence.at(other, y)));
      }
      different += std::isnan(a) != std::isnan(b) || std::abs(a - b) > 0.01F ? 1 : 0;
    }
  }
  EXPECT_LE(different, 2 * kWidth * kHeight / 100);
}

TEST_P(SymmetricSelection, DoesNotDependOnThePlanOrTheRequest) {
  const auto pair = textured_pair(kWidth, kHeight, {-3, 14}, PixelKind::kColour8, 23);
  MatchOptions options = this->options();
  options.parameters.subpixel = Subpixel::kParabola;
  const DisparityMaps expected =
      maps_of(pair, options, {.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  EXPECT_TRUE(identical(
      maps_of(pair, options, {.threads = 3, .strip_width_px = 7, .band_height_px = 5}), expected));
  EXPECT_TRUE(identical(
      maps_of(
          pair, options,
          {.threads = 2, .executor = scheduler::ExecutorKind::kOpenMp, .iterations_per_pass = 3}),
      expected));
  const DisparityMaps alone =
      maps_of(pair, options, {.threads = 2}, {.left = false, .confidence = true});
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    EXPECT_TRUE(is_equal(alone.right.disparity_px.at(x, y), expected.right.disparity_px.at(x, y)));
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, SymmetricSelection,
                         ::testing::Range(0, static_cast<int>(method_cases({}).size())),
                         [](const auto& instance) {
                           return method_cases({})[static_cast<std::size_t>(instance.param)].name;
                         });

/// Without noise a texture without repetition is found again.
TEST(SymmetricSelectionOfBookPairs, IsExactWithoutNoise) {
  BookPairOptions generated = book_pair_options("real-square");
  generated.float_pixels = true;
  BookPair book = make_book_pair(generated);
  const PhotographPair pair{std::move(book.left), std::move(book.right)};
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.disparities = book.search;
  options.parameters.aggregation = Aggregation::kNone;
  options.parameters.selection = Selection::kSymmetric;
  options.parameters.subpixel = Subpixel::kNone;
  options.parameters.occlusion_penalty = 0.5;
  options.raw = true;
  const DisparityMaps maps = maps_of(pair, options);
  int occluded = 0;
  int matched = 0;
  const auto check = [&](const MatchedMap& map, const DisparityMap& truth, const Mask& mask) {
    for (const auto [x, y] : positions_of(truth)) {
      if (mask.at(x, y) == 0) {
        ASSERT_EQ(map.disparity_px.at(x, y), truth.at(x, y)) << x << ", " << y;
      } else {
        ++occluded;
        matched += map.unmatched.at(x, y) == 0 ? 1 : 0;
      }
    }
  };
  check(maps.left, book.left_disparity, book.left_occluded);
  check(maps.right, book.right_disparity, book.right_occluded);
  EXPECT_GT(occluded, 200);
  EXPECT_LE(matched, occluded / 20);  // by chance
}

TEST(SymmetricSelectionMaps, AreFilledWhereUnmatched) {
  const auto pair = textured_pair(kWidth, kHeight, {-3, 14}, PixelKind::kColour8, 24);
  MatchOptions options;
  options.method = MatchMethod::kMembrane;
  options.disparities = {-3, 14};
  options.parameters.selection = Selection::kSymmetric;
  const DisparityMaps filled = maps_of(pair, options);
  options.raw = true;
  const DisparityMaps raw = maps_of(pair, options);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    EXPECT_FALSE(std::isnan(filled.left.disparity_px.at(x, y)));
    EXPECT_EQ(filled.left.unmatched.at(x, y), raw.left.unmatched.at(x, y));
    EXPECT_EQ(filled.right.unmatched.at(x, y), raw.right.unmatched.at(x, y));
  }
}

TEST(SymmetricSelectionOptions, AreCheckedTogether) {
  MatchOptions options;
  options.parameters.selection = Selection::kSymmetric;
  for (const MatchPreset preset :
       {MatchPreset::kRealtime, MatchPreset::kBalanced, MatchPreset::kQuality}) {
    options.preset = preset;
    EXPECT_EQ(complaint(options), "");
    EXPECT_FALSE(options.resolved_refinement().cross_check);
  }
  options.refinement.cross_check = true;
  EXPECT_THAT(complaint(options), HasSubstr("cross-check is on, expected none with selection"));
  options.refinement.cross_check.reset();
  options.parameters.jump_limit = 3;
  EXPECT_THAT(complaint(options), HasSubstr("it is read by selection scanline"));
  options.parameters.jump_limit.reset();
  options.parameters.occlusion_penalty = 0;
  EXPECT_THAT(complaint(options), HasSubstr("occlusion-penalty is 0, expected"));
  options.parameters.occlusion_penalty.reset();
  options.parameters.candidate_step_px = 0.5;
  EXPECT_THAT(complaint(options), HasSubstr("candidate-step is 0.5, expected 1 with selection"));
  options.parameters.candidate_step_px.reset();
  options.preset.reset();
  options.disparities_y = DisparityRange{-1, 1};
  EXPECT_THAT(complaint(options), HasSubstr("selection is symmetric, expected winner"));
  options.disparities_y.reset();
  options.disparities = {0, 5};
  const StereoMatcher matcher(options, execution());
  const auto pair = textured_pair(kWidth, kHeight, {0, 5}, PixelKind::kGrey8, 25);
  const std::vector<OtherView> others = {{&pair.right, 1}, {&pair.left, 2}};
  DisparityMaps maps;
  EXPECT_THROW(matcher.match_several(pair.left, others, {}, maps), UsageError);
}

}  // namespace vantage::symmetric_selection_test
