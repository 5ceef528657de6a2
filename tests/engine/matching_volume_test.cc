// Volumes beside maps: against the plain transcription, against the winners of the map, and what
// neither volumes nor maps may depend on.

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::matching_volume_test {

constexpr DisparityRange kRange{-3, 17};
constexpr int kWidth = 61;
constexpr int kHeight = 33;

/// Keeps the whole volume.
class KeptVolume final : public VolumeSink {
 public:
  void start(const VolumeShape& shape) override {
    shape_ = shape;
    const auto pixels =
        static_cast<std::size_t>(shape.width_px) * static_cast<std::size_t>(shape.height_px);
    writes_.assign(pixels, 0);
    values_.assign(pixels * static_cast<std::size_t>(shape.candidates()), 0);
  }
  void write(int x, int y, int columns, const float* values) override {
    for (int j = 0; j < columns; ++j) {
      ++writes_[pixel(x + j, y)];
    }
    const auto candidates = static_cast<std::size_t>(shape_.candidates());
    std::copy_n(values, candidates * static_cast<std::size_t>(columns),
                values_.data() + pixel(x, y) * candidates);
  }

  [[nodiscard]] const VolumeShape& shape() const { return shape_; }
  [[nodiscard]] const float* column(int x, int y) const {
    return values_.data() + pixel(x, y) * static_cast<std::size_t>(shape_.candidates());
  }
  [[nodiscard]] bool is_complete() const {
    return std::ranges::all_of(writes_, [](int count) { return count == 1; });
  }
  [[nodiscard]] bool equals(const KeptVolume& other) const {
    return values_.size() == other.values_.size() &&
           std::memcmp(values_.data(), other.values_.data(), sizeof(float) * values_.size()) == 0;
  }
  /// Index of the most likely candidate; −1 where there is none.
  [[nodiscard]] int best(int x, int y) const {
    const float sign = shape_.content == VolumeContent::kProbabilities ? -1.0F : 1.0F;
    int best = -1;
    for (int i = 0; i < shape_.candidates(); ++i) {
      const float value = column(x, y)[i];
      if (!std::isnan(value) && (best < 0 || sign * value < sign * column(x, y)[best])) {
        best = i;
      }
    }
    return best;
  }

 private:
  [[nodiscard]] std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(shape_.width_px) +
           static_cast<std::size_t>(x);
  }

  VolumeShape shape_;
  std::vector<int> writes_;
  std::vector<float> values_;
};

PhotographPair pair_of_test() {
  return textured_pair(kWidth, kHeight, kRange, PixelKind::kColour8, 5);
}

DisparityMaps match_with(const MatchOptions& options, const PhotographPair& pair,
                         Execution& execution, const std::vector<VolumeRequest>& volumes) {
  DisparityMaps maps;
  StereoMatcher(options, execution)
      .match(pair.left, pair.right, {.confidence = true, .volumes = volumes}, maps);
  return maps;
}

/// The presets, and final levels that repeat the coarser one.
std::vector<MethodCase> cases_of_volumes() {
  std::vector<MethodCase> cases = method_cases(kRange);
  MatchOptions options = cases.front().options;
  options.method.reset();
  for (const auto& [preset, name] :
       {std::pair{MatchPreset::kBalanced, "balanced"}, {MatchPreset::kQuality, "quality"}}) {
    options.preset = preset;
    cases.push_back({name, options});
  }
  options.preset = MatchPreset::kBalanced;
  options.parameters.candidate_step_px = 0.5;
  cases.push_back({"balanced_half_steps", options});
  options.parameters.candidate_step_px.reset();
  options.parameters.final_iterations = 0;
  cases.push_back({"balanced_repeated", options});
  return cases;
}

TEST(MatchingVolume, HoldsTheWinnersAndLeavesMapsAsTheyAre) {
  const PhotographPair pair = pair_of_test();
  Execution execution({.threads = 2, .strip_width_px = 23, .band_height_px = 9});
  Execution other({.threads = 1});
  for (const MethodCase& method : cases_of_volumes()) {
    SCOPED_TRACE(method.name);
    KeptVolume left;
    KeptVolume right;
    KeptVolume again;
    KeptVolume costs;
    const auto maps =
        match_with(method.options, pair, execution,
                   {{.side = Side::kLeft, .sink = &left},
                    {.side = Side::kRight, .sink = &right},
                    {.side = Side::kLeft, .kind = VolumeKind::kCosts, .sink = &costs}});
    const auto plain = match_with(method.options, pair, other, {});
    EXPECT_TRUE(identical(maps.left.disparity_px, plain.left.disparity_px));
    EXPECT_TRUE(identical(maps.left.confidence, plain.left.confidence));
    EXPECT_TRUE(identical(maps.right.disparity_px, plain.right.disparity_px));
    match_with(method.options, pair, other, {{.side = Side::kLeft, .sink = &again}});
    EXPECT_TRUE(left.equals(again));
    EXPECT_TRUE(left.is_complete() && right.is_complete() && costs.is_complete());
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const KeptVolume& volume = side == Side::kLeft ? left : right;
      ASSERT_EQ(volume.shape().disparities, kRange);
      int wrong = 0;
      for (const auto [x, y] : positions_of(kWidth, kHeight)) {
        const float winner = maps.of(side).disparity_px.at(x, y);
        const int best = volume.best(x, y);
        wrong += best < 0 ? !std::isnan(winner)
                          : winner != static_cast<float>(volume.shape().disparity_px(best));
      }
      EXPECT_EQ(wrong, 0);
    }
  }
}

/// Values agree but for rounding; `strays`: share of cells of columns where rounding decides
/// whether diffusion stops.
void expect_near(const KeptVolume& volume, const Volume& expected, double strays) {
  constexpr double kTolerance = 1e-3;
  int cells = 0;
  int wrong = 0;
  for_each_cell(expected, [&](int x, int y, int i) {
    const double cell = expected.at(x, y, i);
    const float value = volume.column(x, y)[i];
    if (!expected.has_partner(x, i) || std::isnan(cell)) {
      EXPECT_TRUE(std::isnan(value)) << x << ", " << y << ": " << i;
      return;
    }
    const double wanted =
        volume.shape().content == VolumeContent::kProbabilities ? std::exp(-cell) : cell;
    ++cells;
    wrong += std::abs(value - wanted) <= kTolerance * std::max(1.0, std::abs(wanted)) ? 0 : 1;
  });
  EXPECT_GT(cells, kWidth * kHeight * 10);
  EXPECT_LE(wrong, strays * cells);
}

TEST(MatchingVolume, EqualsThePlainTranscription) {
  const PhotographPair pair = textured_pair(kWidth, kHeight, kRange, PixelKind::kGrey8, 5);
  Execution execution({.threads = 2, .strip_width_px = 19});
  for (const MethodCase& method : method_cases(kRange)) {
    SCOPED_TRACE(method.name);
    const MethodParameters parameters = method.options.resolved();
    if (is_stepped(method) || !method.options.method) {
      continue;
    }
    KeptVolume cells;
    KeptVolume costs;
    match_with(method.options, pair, execution,
               {{.sink = &cells}, {.kind = VolumeKind::kCosts, .sink = &costs}});
    expect_near(cells, plain_aggregate(pair.left, pair.right, Side::kLeft, kRange, parameters),
                parameters.aggregation == Aggregation::kLocalStopping ? 0.01 : 0);
    expect_near(
        costs,
        has_likelihoods(parameters)
            ? plain_measurement_energies(pair.left, pair.right, Side::kLeft, kRange, parameters)
            : plain_costs(pair.left, pair.right, Side::kLeft, kRange, parameters),
        0);
  }
}

TEST(MatchingVolume, CoarseCostsAreMeansOfFineOnes) {
  const PhotographPair pair = pair_of_test();
  MatchOptions options;
  options.method = MatchMethod::kDiffusion;
  options.disparities = kRange;
  options.raw = true;
  options.parameters.levels = 3;
  KeptVolume fine;
  KeptVolume coarse;
  match_with(options, pair, execution(),
             {{.kind = VolumeKind::kCosts, .sink = &fine},
              {.kind = VolumeKind::kCosts, .level = 1, .sink = &coarse}});
  ASSERT_EQ(coarse.shape().width_px, (kWidth + 1) / 2);
  ASSERT_EQ(coarse.shape().height_px, (kHeight + 1) / 2);
  int compared = 0;
  for (const auto [x, y] : positions_of(kWidth / 2, kHeight / 2)) {
    for (int i = 0; i < kRange.count(); ++i) {
      const float value = coarse.column(x, y)[i];
      const int partner = 2 * x - (kRange.min + i);
      const bool has_partner = partner + 1 >= 0 && partner < kWidth;
      EXPECT_EQ(std::isnan(value), !has_partner) << x << ": " << i;
      const float sum = fine.column(2 * x, 2 * y)[i] + fine.column(2 * x + 1, 2 * y)[i] +
                        fine.column(2 * x, 2 * y + 1)[i] + fine.column(2 * x + 1, 2 * y + 1)[i];
      if (!std::isnan(sum)) {
        EXPECT_NEAR(value, sum / 4, 1e-3F * std::max(64.0F, sum));
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(MatchingVolume, ProbabilitiesOfPrunedLevelsSumToOne) {
  const PhotographPair pair = textured_pair(96, 64, {0, 79}, PixelKind::kGrey8, 9);
  MatchOptions options;
  options.preset = MatchPreset::kBalanced;
  options.disparities = {0, 79};
  for (const int level : {0, 1, 2}) {
    KeptVolume volume;
    match_with(options, pair, execution(), {{.level = level, .sink = &volume}});
    EXPECT_EQ(volume.shape().content, VolumeContent::kProbabilities);
    const int x = volume.shape().width_px - 1;  // where all have partners
    const int y = volume.shape().height_px / 2;
    double sum = 0;
    int searched = 0;
    for (int i = 0; i < 80; ++i) {
      const float value = volume.column(x, y)[i];
      sum += std::isnan(value) ? 0 : static_cast<double>(value);
      searched += std::isnan(value) ? 0 : 1;
    }
    EXPECT_NEAR(sum, 1, 1e-4) << level;
    EXPECT_EQ(searched < 80, level < 2) << level << ": " << searched;
  }
}

TEST(MatchingVolume, TwoDimensionalSearch) {
  const PhotographPair pair = pair_of_test();
  Execution execution({.threads = 2, .strip_width_px = 17});
  for (const MatchMethod method :
       {MatchMethod::kSsd, MatchMethod::kGradient, MatchMethod::kBayes}) {
    MatchOptions options;
    options.method = method;
    options.disparities = kRange;
    options.disparities_y = DisparityRange{-1, 2};
    options.raw = true;
    options.parameters.subpixel = Subpixel::kNone;
    options.parameters.border =
        method == MatchMethod::kSsd ? std::optional(Border::kValid) : std::nullopt;
    KeptVolume volume;
    const auto maps = match_with(options, pair, execution, {{.sink = &volume}});
    ASSERT_EQ(volume.shape().disparities_y, options.disparities_y);
    int wrong = 0;
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      const int best = volume.best(x, y);
      const float dx = maps.left.disparity_px.at(x, y);
      const float dy = maps.left.disparity_y_px.at(x, y);
      wrong +=
          best < 0
              ? !std::isnan(dx)
              : dx != static_cast<float>(kRange.min + best % kRange.count()) ||
                    dy != static_cast<float>(options.disparities_y->min + best / kRange.count());
    }
    EXPECT_EQ(wrong, 0);
  }
}

TEST(MatchingVolume, IsTheSameForASelectionAlongRows) {
  const PhotographPair pair = pair_of_test();
  Execution execution({.threads = 2, .strip_width_px = 17, .band_height_px = 5});
  for (MethodCase& method : method_cases(kRange)) {
    if (method.name != "ssd_valid" && method.name != "membrane" && method.name != "bayes" &&
        method.name != "bayes_maximum_levels" && method.name != "truncated_box") {
      continue;
    }
    SCOPED_TRACE(method.name);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      KeptVolume of_winners;
      method.options.parameters.selection.reset();
      match_with(method.options, pair, execution, {{.side = side, .sink = &of_winners}});
      for (const Selection selection : {Selection::kScanline, Selection::kSymmetric}) {
        KeptVolume of_rows;
        method.options.parameters.selection = selection;
        match_with(method.options, pair, execution, {{.side = side, .sink = &of_rows}});
        EXPECT_TRUE(of_rows.is_complete());
        EXPECT_TRUE(of_rows.equals(of_winners));
      }
    }
  }
}

TEST(MatchingVolume, RefusesWhatIsNotThere) {
  const PhotographPair pair = pair_of_test();
  KeptVolume volume;
  MatchOptions options;
  options.preset = MatchPreset::kBalanced;
  options.disparities = kRange;
  EXPECT_THROW(match_with(options, pair, execution(), {{.level = 10, .sink = &volume}}),
               UsageError);
  options.preset = MatchPreset::kRealtime;
  EXPECT_THROW(match_with(options, pair, execution(), {{.sink = &volume}}), UsageError);
}

}  // namespace vantage::matching_volume_test
