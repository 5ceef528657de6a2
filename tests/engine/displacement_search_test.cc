// Searches in two dimensions: the candidates of a pixel are all pairs (u, v) of a horizontal and a
// vertical disparity, compared with a plain transcription over those pairs.

#include "engine/io/images/photograph_io.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"
#include "tests/engine/plain_aggregation.h"
#include "tests/engine/plain_column.h"
#include "tests/engine/plain_cost_cells.h"
#include "tests/test_paths.h"
#include "tests/test_sample.h"

namespace vantage::displacement_search_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Shows in the right image what the left one shows, moved by (u, v) with x_left − x_right = u and
/// y_left − y_right = v.
PhotographPair moved_pair(int width, int height, int u, int v, PixelKind kind, std::uint32_t seed) {
  constexpr int kMargin = 12;
  const PhotographPair large =
      textured_pair(width + 2 * kMargin, height + 2 * kMargin, {0, 0}, kind, seed);
  return {crop(large.left, kMargin, kMargin, width, height),
          crop(large.left, kMargin + u, kMargin + v, width, height)};
}

/// All pairs of disparities of one reference.
struct PlainGrid {
  DisparityRange across;
  DisparityRange down;
  int direction = -1;
  int width = 0;
  int height = 0;

  [[nodiscard]] int count() const { return across.count() * down.count(); }
  [[nodiscard]] int u(int i) const { return across.min + i % across.count(); }
  [[nodiscard]] int v(int i) const { return down.min + i / across.count(); }
  [[nodiscard]] bool has_partner(int x, int y, int i) const {
    const int column = x + direction * u(i);
    const int row = y + direction * v(i);
    return column >= 0 && column < width && row >= 0 && row < height;
  }
  /// In px².
  [[nodiscard]] double squared_distance(int i, int j) const {
    return std::pow(u(i) - u(j), 2) + std::pow(v(i) - v(j), 2);
  }
};

/// E0 of all pairs: −log p0 for Bayes.
Volume plain_pair_costs(const Photograph& reference, const Photograph& other, const PlainGrid& grid,
                        const MethodParameters& parameters) {
  const bool is_bayes = parameters.aggregation == Aggregation::kBayes;
  const bool is_relative = is_bayes && parameters.cost == MatchCost::kGradient;
  Volume costs(grid.width, grid.height, {0, grid.count() - 1}, Side::kLeft);
  costs.is_coarse = true;  // which candidates have partners is up to the grid
  for (int v = grid.down.min; v <= grid.down.max; ++v) {
    const PlainCostCells cells(
        parameters, {grid.width, grid.across.min, grid.across.count(), grid.direction}, reference,
        {{&other, 1, v}},
        is_bayes && !is_relative ? CellMeaning::kLikelihood : CellMeaning::kEnergy);
    for (const auto [x, y] : positions_of(grid.width, grid.height)) {
      const std::vector<double> column = cells.column(x, y);
      for (int i = 0; i < grid.across.count(); ++i) {
        const double cell = column[static_cast<std::size_t>(i)];
        costs.at(x, y, (v - grid.down.min) * grid.across.count() + i) =
            is_bayes && !is_relative ? -std::log(cell) : cell;
      }
    }
  }
  for (int y = 0; is_relative && y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      double min = std::numeric_limits<double>::infinity();
      for (int i = 0; i < grid.count(); ++i) {
        min = grid.has_partner(x, y, i) ? std::min(min, costs.at(x, y, i)) : min;
      }
      for (int i = 0; i < grid.count(); ++i) {
        const double epsilon = parameters.epsilon_measurement;
        const double likeness = std::exp((min - costs.at(x, y, i)) / parameters.sigma_measurement);
        costs.at(x, y, i) =
            -std::log(grid.has_partner(x, y, i) ? (1 - epsilon) * likeness + epsilon : epsilon);
      }
    }
  }
  return costs;
}

/// Means over the samples of a window that lie in both images.
Volume plain_pair_boxes(const Volume& costs, const PlainGrid& grid, int radius) {
  Volume result = costs;
  for_each_cell(costs, [&](int x, int y, int i) {
    double sum = 0;
    int samples = 0;
    for (int row = std::max(0, y - radius); row <= std::min(grid.height - 1, y + radius); ++row) {
      for (int column = std::max(0, x - radius); column <= std::min(grid.width - 1, x + radius);
           ++column) {
        if (grid.has_partner(column, row, i)) {
          sum += costs.at(column, row, i);
          ++samples;
        }
      }
    }
    result.at(x, y, i) = samples > 0 ? sum / samples : kNan;
  });
  return result;
}

void normalise(Volume& energies) {
  for (const auto [x, y] : positions_of(energies.width, energies.height)) {
    double min = std::numeric_limits<double>::infinity();
    for (int i = 0; i < energies.count(); ++i) {
      min = std::min(min, energies.at(x, y, i));
    }
    double sum = 0;
    for (int i = 0; i < energies.count(); ++i) {
      sum += std::exp(min - energies.at(x, y, i));
    }
    for (int i = 0; i < energies.count(); ++i) {
      energies.at(x, y, i) += std::log(sum) - min;
    }
  }
}

/// (6.32)–(6.37) over pairs, in energies −log p: the prior is one of the length of an offset, of
/// whose sum all terms count, or the largest.
Volume plain_pair_bayes(const Volume& first, const PlainGrid& grid,
                        const MethodParameters& parameters) {
  Volume energies = first;
  normalise(energies);
  for (int n = 0; n < parameters.iterations; ++n) {
    Volume smooth = energies;
    for (const auto [x, y] : positions_of(first.width, first.height)) {
      std::vector<double> column;
      for (int i = 0; i < first.count(); ++i) {
        column.push_back(energies.at(x, y, i));
      }
      for (int i = 0; i < first.count(); ++i) {
        std::vector<double> penalties;
        for (int j = 0; j < first.count(); ++j) {
          penalties.push_back(plain_penalty(parameters, grid.squared_distance(i, j)));
        }
        smooth.at(x, y, i) = plain_support(penalties, column, parameters.prior_smoothing);
      }
    }
    for_each_cell(first, [&](int x, int y, int i) {
      double sum = smooth.at(x, y, i);
      sum += x > 0 ? smooth.at(x - 1, y, i) : 0;
      sum += x + 1 < first.width ? smooth.at(x + 1, y, i) : 0;
      sum += y > 0 ? smooth.at(x, y - 1, i) : 0;
      sum += y + 1 < first.height ? smooth.at(x, y + 1, i) : 0;
      energies.at(x, y, i) = first.at(x, y, i) + parameters.mu * sum;
    });
    normalise(energies);
  }
  return energies;
}

Volume plain_pair_energies(const Volume& costs, const PlainGrid& grid,
                           const MethodParameters& parameters) {
  const int n = parameters.iterations;
  switch (parameters.aggregation) {
    case Aggregation::kNone:
      return costs;
    case Aggregation::kBox:
      return plain_pair_boxes(costs, grid, parameters.window_px / 2);
    case Aggregation::kGaussian:
      return plain_convolution(costs, gaussian_taps(parameters.aggregation_sigma_px));
    case Aggregation::kBoxCascade:
      return plain_convolution(costs, box_cascade_taps(parameters.aggregation_sigma_px));
    case Aggregation::kDiffusion:
      return plain_diffusion(costs, parameters.lambda, n);
    case Aggregation::kMembrane:
      return plain_membrane(costs, parameters.lambda, parameters.beta, n);
    case Aggregation::kLocalStopping:
      return plain_local_stopping(costs, parameters.lambda, parameters.certainty,
                                  plain_entropy_scale(parameters), n);
    case Aggregation::kBayes:
      return plain_pair_bayes(costs, grid, parameters);
  }
  return costs;
}

/// Raw maps of one reference against the transcription. Winners that lead by little may differ.
void expect_equals_pairs(const PhotographPair& pair, const MatchOptions& options, Side reference,
                         const DisparityMaps& maps) {
  const bool is_left = reference == Side::kLeft;
  const MethodParameters parameters = options.resolved();
  const PlainGrid grid{options.disparities, *options.disparities_y, is_left ? -1 : 1,
                       pair.left.width(), pair.left.height()};
  const Volume energies =
      plain_pair_energies(plain_pair_costs(is_left ? pair.left : pair.right,
                                           is_left ? pair.right : pair.left, grid, parameters),
                          grid, parameters);
  const DisparityMap& map_x = is_left ? maps.left.disparity_px : maps.right.disparity_px;
  const DisparityMap& map_y = is_left ? maps.left.disparity_y_px : maps.right.disparity_y_px;
  const Image<float>& confidence = is_left ? maps.left.confidence : maps.right.confidence;
  const Tolerance tolerance = tolerance_of(parameters);
  int distinct = 0;
  int equal = 0;
  int confident = 0;
  std::string first;
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      std::vector<double> column;
      std::vector<double> others;
      for (int i = 0; i < grid.count(); ++i) {
        column.push_back(grid.has_partner(x, y, i) ? energies.at(x, y, i) : kNan);
      }
      const PlainColumn plain(column);
      ASSERT_EQ(plain.has_candidate(), !std::isnan(map_x.at(x, y))) << x << ", " << y;
      ASSERT_EQ(plain.has_candidate(), !std::isnan(map_y.at(x, y))) << x << ", " << y;
      if (!plain.has_candidate()) {
        continue;
      }
      const int winner = plain.winner();
      others = column;
      others[static_cast<std::size_t>(winner)] = kNan;
      const PlainColumn rest(others);
      const double floor = parameters.aggregation == Aggregation::kBayes ? 1 : tolerance.floor;
      const double magnitude = std::max(std::abs(plain.min()), floor);
      if (rest.has_candidate() && rest.min() - plain.min() <= 10 * tolerance.tie * magnitude) {
        continue;
      }
      ++distinct;
      const auto refined = [&](int place, int count, int step) {
        if (options.parameters.subpixel == Subpixel::kNone || place == 0 || place + 1 == count) {
          return 0.0;
        }
        const double below = column[static_cast<std::size_t>(winner - step)];
        const double above = column[static_cast<std::size_t>(winner + step)];
        const double curvature = below - 2 * plain.min() + above;
        return curvature > 0 ? (below - above) / (2 * curvature) : 0;
      };
      const int in_row = grid.across.count();
      const double u = grid.u(winner) + refined(winner % in_row, in_row, 1);
      const double v = grid.v(winner) + refined(winner / in_row, grid.down.count(), in_row);
      const double off = std::max(std::abs(map_x.at(x, y) - u), std::abs(map_y.at(x, y) - v));
      const double allowed_px = std::max(2e-3, 3 * tolerance.subpixel_px);
      equal += off <= allowed_px ? 1 : 0;
      const double sure = parameters.aggregation == Aggregation::kBayes ? std::exp(-plain.min())
                          : parameters.aggregation == Aggregation::kLocalStopping &&
                                  parameters.certainty == Certainty::kEntropy
                              ? plain.entropy(plain_entropy_scale(parameters))
                          : is_evidence(parameters) ? -plain.min()
                                                    : plain.margin();
      const double unsure = std::abs(confidence.at(x, y) - sure) /
                            std::max(std::abs(sure), tolerance.confidence_floor);
      confident += unsure <= tolerance.confidence ? 1 : 0;
      if ((off > allowed_px || unsure > tolerance.confidence) && first.empty()) {
        first = "at " + std::to_string(x) + ", " + std::to_string(y) + ": " +
                std::to_string(map_x.at(x, y)) + ", " + std::to_string(map_y.at(x, y)) +
                ", expected " + std::to_string(u) + ", " + std::to_string(v) + "; confidence " +
                std::to_string(confidence.at(x, y)) + ", expected " + std::to_string(sure);
      }
    }
  }
  // Single cells often tie.
  const bool is_single = parameters.aggregation == Aggregation::kNone;
  EXPECT_GT(distinct, is_single ? 0 : grid.width * grid.height / 3);
  EXPECT_GE(equal, 0.98 * distinct - 2) << "of " << distinct << ", " << first;
  EXPECT_GE(confident, 0.9 * distinct - 2) << "of " << distinct << ", " << first;
}

constexpr MatchCost kCosts[] = {MatchCost::kSquared,         MatchCost::kTruncated,
                                MatchCost::kGradient,        MatchCost::kContaminated,
                                MatchCost::kCensus,          MatchCost::kRayCensus,
                                MatchCost::kBirchfieldTomasi};
constexpr Aggregation kAggregations[] = {Aggregation::kNone,          Aggregation::kBox,
                                         Aggregation::kGaussian,      Aggregation::kBoxCascade,
                                         Aggregation::kDiffusion,     Aggregation::kMembrane,
                                         Aggregation::kLocalStopping, Aggregation::kBayes};
struct Ranges {
  DisparityRange across;
  DisparityRange down;
};
constexpr Ranges kRanges[] = {
    {{-1, 4}, {-2, 2}}, {{0, 16}, {0, 2}}, {{0, 0}, {-4, 3}}, {{-2, 3}, {1, 1}}};

MatchOptions options_of(MatchCost cost, Aggregation aggregation, const Ranges& ranges) {
  MatchOptions options;
  options.raw = true;
  options.disparities = ranges.across;
  options.disparities_y = ranges.down;
  options.parameters.cost = cost;
  options.parameters.aggregation = aggregation;
  if (aggregation == Aggregation::kBox) {
    options.parameters.window_px = 5;
  } else if (aggregation >= Aggregation::kDiffusion) {
    options.parameters.iterations = 3;
  }
  if (cost == MatchCost::kGradient && aggregation == Aggregation::kLocalStopping) {
    options.parameters.certainty = Certainty::kEntropy;  // there is no margin of evidence
  }
  return options;
}

class DisplacementSearch : public ::testing::TestWithParam<int> {};

TEST_P(DisplacementSearch, EqualsAPlainSearchOverPairs) {
  static const auto rows =
      sampled_rows({static_cast<int>(std::size(kAggregations)), static_cast<int>(std::size(kCosts)),
                    static_cast<int>(std::size(kRanges)), 6, 2});
  for (const SampleRow& row : rows_of(rows, GetParam())) {
    const Ranges& ranges = kRanges[row[2]];
    const bool is_left = row[4] == 0;
    SCOPED_TRACE(case_name(kCosts[row[1]]) + ", ranges " + std::to_string(row[2]) + ", prior " +
                 std::to_string(row[3]) + ", left " + std::to_string(is_left) + ", " +
                 sample_name());
    MatchOptions options = options_of(kCosts[row[1]], kAggregations[row[0]], ranges);
    if (kAggregations[row[0]] == Aggregation::kBayes) {
      options.parameters.prior_smoothing =
          row[3] % 2 == 0 ? PriorSmoothing::kSum : PriorSmoothing::kMaximum;
      options.parameters.prior = static_cast<Prior>(row[3] / 2);
    }
    const PhotographPair pair =
        textured_pair(31, 23, ranges.across, PixelKind::kGrey8, static_cast<unsigned>(row[1]) + 1);
    expect_equals_pairs(pair, options, is_left ? Side::kLeft : Side::kRight,
                        maps_of(pair, options));
  }
}

INSTANTIATE_TEST_SUITE_P(Aggregations, DisplacementSearch,
                         ::testing::Range(0, static_cast<int>(std::size(kAggregations))),
                         [](const auto& instance) {
                           return case_name(kAggregations[instance.param]);
                         });

/// Nothing at the borders reaches pixels that are so far from them.
constexpr int kBorder = 12;

double share_right(const DisparityMaps& maps, double u, double v) {
  int right = 0;
  int all = 0;
  for (const auto [x, y] : positions_of({kBorder, maps.left.disparity_px.width() - kBorder},
                                        {kBorder, maps.left.disparity_px.height() - kBorder})) {
    ++all;
    right += std::abs(maps.left.disparity_px.at(x, y) - u) <= 0.5 &&
                     std::abs(maps.left.disparity_y_px.at(x, y) - v) <= 0.5
                 ? 1
                 : 0;
  }
  return static_cast<double>(right) / all;
}

double inner_median(const DisparityMap& map) {
  std::vector<float> values;
  for (int y = kBorder; y < map.height() - kBorder; ++y) {
    values.insert(values.end(), map.row(y) + kBorder, map.row(y) + map.width() - kBorder);
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// All methods, then all presets.
MatchOptions method_or_preset(int number) {
  constexpr MatchMethod kMethods[] = {MatchMethod::kSsd,           MatchMethod::kGradient,
                                      MatchMethod::kDiffusion,     MatchMethod::kMembrane,
                                      MatchMethod::kLocalStopping, MatchMethod::kBayes};
  constexpr MatchPreset kPresets[] = {MatchPreset::kBalanced, MatchPreset::kQuality};
  MatchOptions options;
  options.raw = true;
  if (number < 6) {
    options.method = kMethods[number];
  } else {
    options.preset = kPresets[number - 6];
  }
  return options;
}
constexpr int kMethodsAndPresets = 8;

TEST(DisplacementSearchOfMethods, FindsWholeShiftsEverywhere) {
  struct Shift {
    Ranges ranges;
    int u;
    int v;
  };
  constexpr Shift kShifts[] = {{{{0, 7}, {-2, 3}}, 3, 1}, {{{0, 0}, {-4, 4}}, 0, -2}};
  for (const Shift& shift : kShifts) {
    const PhotographPair pair = moved_pair(72, 56, shift.u, shift.v, PixelKind::kGrey8, 5);
    for (int number = 0; number < kMethodsAndPresets; ++number) {
      MatchOptions options = method_or_preset(number);
      options.disparities = shift.ranges.across;
      options.disparities_y = shift.ranges.down;
      EXPECT_EQ(share_right(maps_of(pair, options), shift.u, shift.v), 1)
          << "method or preset " << number << ", vertical shift " << shift.v;
    }
  }
}

TEST(DisplacementSearchOfMethods, FindsWholeAndHalfShiftsOfAPhotograph) {
  const std::filesystem::path folder = test_paths::shared_data("cones");
  if (folder.empty()) {
    GTEST_SKIP() << "no photographs in ../shared/data/cones";
  }
  const Photograph photograph = read_photograph(folder / "im2.png");
  constexpr int kWidth = 90;
  constexpr int kHeight = 60;
  const auto part = [&](int x, int y) { return crop(photograph, x, y, kWidth, kHeight); };
  // Means of neighbours in both directions: half a pixel on.
  const auto half_way = [&](int x, int y) {
    Image<std::uint8_t> means(kWidth, kHeight, 3);
    std::vector<Photograph> parts;
    for (const int step : {0, 1, 2, 3}) {
      parts.push_back(part(x + step % 2, y + step / 2));
    }
    for (const auto [i, row] : positions_of(3 * kWidth, kHeight)) {
      int sum = 0;
      for (const Photograph& one : parts) {
        sum += std::get<Image<std::uint8_t>>(one.pixels).row(row)[i];
      }
      means.row(row)[i] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
    return Photograph{std::move(means)};
  };
  const PhotographPair whole{part(180, 160), part(183, 161)};
  const PhotographPair half{part(180, 160), half_way(182, 161)};
  for (int number = 0; number < kMethodsAndPresets; ++number) {
    MatchOptions options = method_or_preset(number);
    options.disparities = {0, 6};
    options.disparities_y = {-1, 3};
    EXPECT_GE(share_right(maps_of(whole, options), 3, 1), 0.99) << number;
    const DisparityMaps between = maps_of(half, options);
    EXPECT_NEAR(inner_median(between.left.disparity_px), 2.5, 0.25) << number;
    EXPECT_NEAR(inner_median(between.left.disparity_y_px), 1.5, 0.25) << number;
  }
}

TEST(DisplacementSearchOfMethods, OfOneVerticalDisparityOf0IsASearchAlongRows) {
  const PhotographPair pair = textured_pair(61, 37, {0, 11}, PixelKind::kGrey8, 3);
  for (int number = 0; number < kMethodsAndPresets; ++number) {
    MatchOptions options = method_or_preset(number);
    options.disparities = {0, 11};
    options.parameters.subpixel = Subpixel::kNone;
    if (options.preset) {
      options.parameters.candidate_blocks = 0;
      options.parameters.slant_penalty = std::numeric_limits<double>::infinity();
    }
    const DisparityMaps expected = maps_of(pair, options);
    options.disparities_y = {0, 0};
    EXPECT_TRUE(identical(expected.left.disparity_px, maps_of(pair, options).left.disparity_px))
        << number;
  }
}

}  // namespace vantage::displacement_search_test
