// Selection along rows (§3.15) of every aggregation against a plain transcription: what the
// matcher selects costs no more than the best path through the oracle's energies.

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/option_complaint.h"
#include "tests/engine/oracle_comparison.h"
#include "tests/engine/plain_matching.h"

namespace vantage::scanline_selection_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One row of the oracle's energies.
struct PlainRow {
  const Volume& energies;
  int y;
  const MethodParameters& parameters;

  [[nodiscard]] bool counts(int x, int i) const {
    return energies.has_partner(x, i) && !std::isnan(energies.at(x, y, i));
  }
  [[nodiscard]] double jump(int a, int b) const {
    return std::min(parameters.jump_penalty * std::abs(a - b), parameters.jump_limit);
  }
  /// The best total, every candidate of a column from every one of the column before. Columns
  /// without candidates separate paths.
  [[nodiscard]] double best_total() const {
    double total = 0;
    std::vector<double> before;  // empty: a path starts
    for (int x = 0; x < energies.width; ++x) {
      std::vector<double> paths(static_cast<std::size_t>(energies.count()), kInfinity);
      for (int i = 0; i < energies.count(); ++i) {
        if (!counts(x, i)) {
          continue;
        }
        double from = before.empty() ? 0 : kInfinity;
        for (std::size_t k = 0; k < before.size(); ++k) {
          from = std::min(from, before[k] + jump(static_cast<int>(k), i));
        }
        paths[static_cast<std::size_t>(i)] = from + energies.at(x, y, i);
      }
      if (*std::min_element(paths.begin(), paths.end()) == kInfinity) {
        total += before.empty() ? 0 : *std::min_element(before.begin(), before.end());
        paths.clear();
      }
      before = paths;
    }
    return total + (before.empty() ? 0 : *std::min_element(before.begin(), before.end()));
  }
  [[nodiscard]] double total_of(const float* disparities) const {
    double total = 0;
    int before = -1;
    for (int x = 0; x < energies.width; ++x) {
      if (std::isnan(disparities[x])) {
        before = -1;
        continue;
      }
      const int i = static_cast<int>(disparities[x]) - energies.range.min;
      if (i < 0 || i >= energies.count() || !counts(x, i)) {
        return kInfinity;
      }
      total += energies.at(x, y, i) + (before < 0 ? 0 : jump(before, i));
      before = i;
    }
    return total;
  }
};

class ScanlineSelection : public ::testing::TestWithParam<int> {
 protected:
  static const std::vector<MethodCase>& methods() {
    static const auto cases = method_cases({-3, 14});
    return cases;
  }
  static MatchOptions options() {
    MatchOptions options = methods()[static_cast<std::size_t>(GetParam())].options;
    options.parameters.selection = Selection::kScanline;
    return options;
  }
};

TEST_P(ScanlineSelection, CostsNoMoreThanTheBestPath) {
  const auto pair = textured_pair(47, 19, {-3, 14}, PixelKind::kGrey8, 11);
  MatchOptions options = this->options();
  for (const double share : {0.2, 1.0}) {
    options.parameters.jump_penalty = share * options.resolved().jump_limit;
    const MethodParameters parameters = options.resolved();
    const DisparityMaps maps = maps_of(pair, options);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const bool is_left = side == Side::kLeft;
      const Volume energies =
          plain_aggregate(is_left ? pair.left : pair.right, is_left ? pair.right : pair.left, side,
                          {-3, 14}, parameters);
      for (int y = 0; y < energies.height; ++y) {
        const PlainRow row{energies, y, parameters};
        const double best = row.best_total();
        // Cells in steps or half floats stray from the oracle's: so may what is selected.
        const double tolerance =
            is_stepped(methods()[static_cast<std::size_t>(GetParam())]) ? 0.05 : 1e-4;
        EXPECT_LE(row.total_of(maps.of(side).disparity_px.row(y)),
                  best + tolerance * std::max(1.0, std::abs(best)))
            << "row " << y << (is_left ? ", left" : ", right") << ", share " << share;
      }
    }
  }
}

TEST_P(ScanlineSelection, FreeJumpsGiveWinners) {
  const auto pair = textured_pair(45, 17, {-3, 14}, PixelKind::kGreyFloat, 12);
  MatchOptions winners = options();
  winners.parameters.selection = Selection::kWinner;
  MatchOptions free = options();
  free.parameters.jump_limit = 0;
  const DisparityMaps expected = maps_of(pair, winners);
  const DisparityMaps maps = maps_of(pair, free);
  int different = 0;
  for (const auto [x, y] : positions_of(45, 17)) {
    const float wanted = expected.left.disparity_px.at(x, y);
    const float got = maps.left.disparity_px.at(x, y);
    EXPECT_EQ(std::isnan(wanted), std::isnan(got));
    // A margin of 0 is a tie, of which a path takes the candidate beside it.
    different += !std::isnan(wanted) && wanted != got && maps.left.confidence.at(x, y) != 0;
    if (wanted == got) {
      const float confidence = expected.left.confidence.at(x, y);
      EXPECT_NEAR(maps.left.confidence.at(x, y), confidence,
                  1e-5 * std::max(1.0F, std::abs(confidence)));
    }
  }
  EXPECT_LE(different, 45 * 17 / 100);  // means of windows are rounded
}

TEST_P(ScanlineSelection, DoesNotDependOnThePlan) {
  const auto pair = textured_pair(59, 23, {-3, 14}, PixelKind::kGrey8, 13);
  MatchOptions options = this->options();
  options.parameters.subpixel = Subpixel::kParabola;
  const DisparityMaps expected =
      maps_of(pair, options, {.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  EXPECT_TRUE(identical(
      maps_of(pair, options, {.threads = 3, .strip_width_px = 7, .band_height_px = 5}), expected));
  EXPECT_TRUE(identical(maps_of(pair, options,
                                {.threads = 2,
                                 .executor = scheduler::ExecutorKind::kOpenMp,
                                 .strip_width_px = 16,
                                 .iterations_per_pass = 3}),
                        expected));
  // Sub-pixel positions stay within half a pixel of what is selected.
  options.parameters.subpixel = Subpixel::kNone;
  const DisparityMaps whole = maps_of(pair, options);
  for (const auto [x, y] : positions_of(59, 23)) {
    if (!std::isnan(whole.left.disparity_px.at(x, y))) {
      EXPECT_LE(std::abs(whole.left.disparity_px.at(x, y) - expected.left.disparity_px.at(x, y)),
                0.5F);
    }
  }
}

TEST(ScanlineSelectionBetweenPixels, StaysWithinHalfAStep) {
  const auto pair = textured_pair(59, 23, {-3, 14}, PixelKind::kGrey8, 14);
  MatchOptions options;
  options.method = MatchMethod::kMembrane;
  options.disparities = {-3, 14};
  options.raw = true;
  options.parameters.selection = Selection::kScanline;
  options.parameters.candidate_step_px = 0.25;
  const DisparityMaps refined = maps_of(pair, options);
  options.parameters.subpixel = Subpixel::kNone;
  const DisparityMaps selected = maps_of(pair, options);
  int fractions = 0;
  for (const auto [x, y] : positions_of(59, 23)) {
    const float px = selected.left.disparity_px.at(x, y);
    EXPECT_EQ(4 * px, std::round(4 * px));
    EXPECT_LE(std::abs(refined.left.disparity_px.at(x, y) - px), 0.125F);
    fractions += px != std::round(px) ? 1 : 0;
  }
  EXPECT_GT(fractions, 0);
}

INSTANTIATE_TEST_SUITE_P(Methods, ScanlineSelection,
                         ::testing::Range(0, static_cast<int>(method_cases({}).size())),
                         [](const auto& instance) {
                           return method_cases({})[static_cast<std::size_t>(instance.param)].name;
                         });

TEST(ScanlineSelectionOptions, AreCheckedTogether) {
  MatchOptions options;
  options.parameters.selection = Selection::kScanline;
  for (const MatchPreset preset :
       {MatchPreset::kRealtime, MatchPreset::kBalanced, MatchPreset::kQuality}) {
    options.preset = preset;
    EXPECT_EQ(complaint(options), "");
    EXPECT_EQ(options.resolved().candidate_blocks, 0);
    EXPECT_EQ(options.resolved().search_size, SearchSize::kFull);
  }
  options.parameters.candidate_blocks = 2;
  EXPECT_THAT(complaint(options), HasSubstr("candidate-blocks is 2, expected 0 with selection"));
  options.parameters.candidate_blocks.reset();
  options.parameters.search_size = SearchSize::kHalf;
  EXPECT_THAT(complaint(options), HasSubstr("selection winner"));
  options.parameters.search_size.reset();
  options.preset.reset();
  options.disparities_y = DisparityRange{-1, 1};
  EXPECT_THAT(complaint(options), HasSubstr("selection is scanline, expected winner"));
  options.disparities_y.reset();
  options.parameters.selection.reset();
  options.parameters.jump_penalty = 1;
  EXPECT_THAT(complaint(options), HasSubstr("it is read by selection scanline"));
}

}  // namespace vantage::scanline_selection_test
