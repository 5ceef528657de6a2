// What visit_fields() says reads a parameter, against what changes when the parameter is changed:
// maps that the matching code makes of given parameters, without the validation that uses the list.
#include "engine/matching/options/parameter_readers.h"
#include "engine/matching/windows/window_level.h"

#include <fmt/format.h>

#include <deque>

#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/costs/cost_image.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/options/method_fields.h"
#include "engine/matching/options/method_names.h"
#include "engine/matching/search/coarse_to_fine/level_search.h"
#include "engine/refinement/refinement_options.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/option_complaint.h"
#include "tests/engine/oracle_comparison.h"
#include "tests/engine/table_keys.h"
#include "tests/test_sample.h"

namespace vantage::parameter_readers_test {

constexpr int kWidth = 31;
constexpr int kHeight = 17;
constexpr DisparityRange kRange{0, 19};  // two blocks of candidates

/// Map and confidence, byte by byte.
using Bytes = std::vector<float>;

class Maps {
 public:
  Maps() {
    pair_ = textured_pair(kWidth, kHeight, kRange, PixelKind::kColour8, 5);
    // Another exposure, and noise that is not that of the book's parameters.
    auto& right = std::get<Image<std::uint8_t>>(pair_.right.pixels);
    for (const auto [i, y] : positions_of(kWidth * right.channels(), kHeight)) {
      right.row(y)[i] = static_cast<std::uint8_t>(right.row(y)[i] * 3 / 4 + 20);
    }
  }

  /// What the parameters make of the pair, whoever may set them.
  const Bytes& of(const MethodParameters& parameters) {
    for (const auto& [known, bytes] : known_) {
      if (known == parameters) {
        return bytes;
      }
    }
    known_.emplace_back(parameters, made_by(parameters));
    return known_.back().second;
  }

 private:
  Bytes made_by(const MethodParameters& parameters) {
    MatchOptions options;  // of which only the range of candidates is made
    options.method = MatchMethod::kSsd;
    options.disparities = kRange;
    options.parameters = as_overrides(parameters);
    const auto geometry = candidate_geometry(options.in_force(), Side::kLeft, kWidth, kHeight);
    CostImage left;
    CostImage right;
    const bool has_windows = parameters.window_levels > 0;
    const auto margins = has_windows ? window_margins(geometry) : geometry;
    left.prepare(pair_.left, parameters, margins, {true, false, false}, execution_);
    right.prepare(pair_.right, parameters, margins,
                  {false, true, has_windows, geometry.steps_per_px}, execution_);
    ChainInput input{nullptr, &left, {CostPartner{&right}}};
    EdgeWeightLevels edges;
    input.edges = edges.prepare(pair_.left, parameters, execution_);
    DisparityMap map(kWidth, kHeight);
    Image<float> confidence(kWidth, kHeight);
    CoarseLevels levels;
    SearchReport report;
    LevelSearch(options.in_force(), parameters, execution_, levels, report)
        .compute(Side::kLeft, input,
                 {.outputs = {.disparity_px = map.view(), .confidence = confidence.view()}});
    Bytes bytes;
    for (const Image<float>* image : {&map, &confidence}) {
      for (int y = 0; y < kHeight; ++y) {
        bytes.insert(bytes.end(), image->row(y), image->row(y) + kWidth);
      }
    }
    return bytes;
  }

  Execution execution_{{.threads = 1}};
  PhotographPair pair_;
  std::deque<std::pair<MethodParameters, Bytes>> known_;  // deque: of() hands out references
};

bool are_equal(const Bytes& a, const Bytes& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Other values of a parameter: what reads it makes another map of one of them.
using Changes = std::vector<std::function<void(MethodOverrides&)>>;

template <typename T>
Changes values_of(std::optional<T> MethodOverrides::*field, std::vector<T> values) {
  Changes changes;
  for (const T value : values) {
    changes.push_back([=](MethodOverrides& parameters) { parameters.*field = value; });
  }
  return changes;
}

const std::map<std::string_view, Changes>& changes() {
  using P = MethodOverrides;
  static const std::map<std::string_view, Changes> all = {
      {"cost", values_of<MatchCost>(&P::cost, {MatchCost::kBirchfieldTomasi, MatchCost::kCensus})},
      {"colour", values_of<ColourUse>(&P::colour, {ColourUse::kChannels})},
      {"truncation", values_of<double>(&P::truncation, {3, 11})},
      {"sigma-measurement", values_of<double>(&P::sigma_measurement, {2, 14})},
      {"epsilon-measurement", values_of<double>(&P::epsilon_measurement, {0.01, 0.4})},
      {"census-thresholds", values_of<int>(&P::census_thresholds, {3})},
      {"alpha", values_of<double>(&P::alpha, {0.3})},
      {"gradient-components",
       values_of<GradientComponents>(&P::gradient_components, {GradientComponents::kX})},
      {"norm", values_of<GradientNorm>(&P::norm, {GradientNorm::kOctagon})},
      {"gradient", values_of<GradientFilter>(&P::gradient, {GradientFilter::kSimoncelli5})},
      {"prefilter", values_of<bool>(&P::prefilter, {false})},
      {"aggregate",
       values_of<Aggregation>(&P::aggregation, {Aggregation::kGaussian, Aggregation::kNone})},
      {"window", values_of<int>(&P::window_px, {3})},
      {"border", values_of<Border>(&P::border, {Border::kValid})},
      {"aggregation-sigma", values_of<double>(&P::aggregation_sigma_px, {0.9, 3.5})},
      {"iterations", values_of<int>(&P::iterations, {1, 5})},
      {"levels", values_of<int>(&P::levels, {2, 4})},
      {"search-size", values_of<SearchSize>(&P::search_size, {SearchSize::kHalf})},
      {"candidate-blocks", values_of<int>(&P::candidate_blocks, {2})},
      {"pruned-levels", values_of<int>(&P::pruned_levels, {1})},
      {"window-levels", values_of<int>(&P::window_levels, {1})},
      {"final-iterations", values_of<int>(&P::final_iterations, {0, 5})},
      {"lambda", values_of<double>(&P::lambda, {0.05})},
      {"beta", values_of<double>(&P::beta, {1.5})},
      {"certainty", values_of<Certainty>(&P::certainty, {Certainty::kEntropy, Certainty::kMargin})},
      {"mu", values_of<double>(&P::mu, {0.2})},
      {"prior", values_of<Prior>(&P::prior, {Prior::kImpulse, Prior::kQuadratic})},
      {"sigma-prior", values_of<double>(&P::sigma_prior, {1.1})},
      {"epsilon-prior", values_of<double>(&P::epsilon_prior, {0.2})},
      {"prior-growth", values_of<double>(&P::prior_growth, {3})},
      {"prior-smoothing",
       values_of<PriorSmoothing>(&P::prior_smoothing,
                                 {PriorSmoothing::kSum, PriorSmoothing::kMaximum})},
      {"level-weight", values_of<double>(&P::level_weight, {0.4})},
      {"slant-penalty", values_of<double>(&P::slant_penalty, {0.25})},
      {"edge-weight", values_of<double>(&P::edge_weight, {0.05})},
      {"edge-contrast", values_of<double>(&P::edge_contrast, {40})},
      {"edge-diffusion", values_of<int>(&P::edge_diffusion, {1, 3})},
      {"selection",
       values_of<Selection>(&P::selection, {Selection::kScanline, Selection::kWinner})},
      {"jump-penalty", values_of<double>(&P::jump_penalty, {0})},
      {"jump-limit", values_of<double>(&P::jump_limit, {0})},
      {"candidate-step", values_of<double>(&P::candidate_step_px, {0.5})},
      {"occlusion-penalty", values_of<double>(&P::occlusion_penalty, {0.5})},
      {"subpixel", values_of<Subpixel>(&P::subpixel, {Subpixel::kNone})},
  };
  return all;
}

const std::vector<MatchCost> kCosts = all_costs();
const std::vector<Aggregation> kAggregations = all_aggregations();

/// Levels, and what Bayesian diffusion is asked for besides.
struct Situation {
  int levels;
  int candidate_blocks;
  double edge_weight;
  Certainty certainty;
};
constexpr std::array kSituations = {Situation{1, 0, 1, Certainty::kMargin},
                                    Situation{3, 0, 0.3, Certainty::kEntropy},
                                    Situation{3, 1, 1, Certainty::kMargin}};

MethodParameters parameters_of(const SampleRow& row) {
  const Situation& situation = kSituations[static_cast<std::size_t>(row[2])];
  MethodOverrides overrides;
  overrides.cost = kCosts[static_cast<std::size_t>(row[0])];
  overrides.aggregation = kAggregations[static_cast<std::size_t>(row[1])];
  overrides.iterations = 3;
  overrides.final_iterations = 2;
  overrides.levels = situation.levels;
  if (situation.candidate_blocks > 0) {
    overrides.prior_smoothing = PriorSmoothing::kMaximum;  // only that is pruned
  }
  if (row[2] < 2) {
    overrides.prior = static_cast<Prior>(row[0] % 3);
  }
  overrides.edge_weight = situation.edge_weight;
  overrides.certainty = situation.certainty;
  if (row[2] == 0 && row[0] % 2 == 1) {
    overrides.selection = Selection::kScanline;
  }
  if (overrides.cost == MatchCost::kGradient &&
      overrides.aggregation == Aggregation::kLocalStopping) {
    overrides.certainty = Certainty::kEntropy;
  }
  MethodParameters parameters = resolve(MatchMethod::kSsd, overrides);
  parameters.candidate_blocks = can_prune(parameters) ? situation.candidate_blocks : 0;
  return parameters;
}

bool is_valid(const MethodParameters& parameters) {
  return error_of([&] { validate(parameters); }).empty();
}

/// Where a parameter is read, but no other value can be had or makes a difference.
bool is_without_difference(std::string_view name, const MethodParameters& parameters) {
  if (name == "candidate-blocks") {
    return !can_prune(parameters);  // it is 0, and only that is accepted
  }
  if (name == "window-levels") {
    return !can_search_windows(parameters);  // likewise
  }
  if (name == "search-size") {
    return true;  // more than one search: see reduced_matcher_test
  }
  if (name == "certainty") {
    return parameters.cost == MatchCost::kGradient;  // which has entropy only
  }
  return false;
}

std::vector<MethodField> fields_of_method() {
  std::vector<MethodField> fields;
  const MethodOverrides none;
  visit_fields([&](const MethodField& field, const auto&) { fields.push_back(field); }, none);
  return fields;
}

/// Names of the options that are set.
std::set<std::string_view> set_in(const MethodOverrides& overrides) {
  std::set<std::string_view> names;
  visit_fields(
      [&](const MethodField& field, const auto& value) {
        if (value) {
          names.insert(field.option);
        }
      },
      overrides);
  return names;
}

TEST(MethodFields, AreVisitedOnceEach) {
  std::set<const void*> fields;
  const MethodOverrides none;
  visit_fields([&](const MethodField&, const auto& value) { fields.insert(&value); }, none);
  EXPECT_EQ(fields.size(), count_fields<MethodParameters>());
  EXPECT_TRUE(set_in(none).empty());
}

TEST(MethodFields, HaveTheNamesOfTheirOptions) {
  for (const auto& [name, changes_of_one] : changes()) {
    for (const auto& change : changes_of_one) {
      MethodOverrides overrides;
      change(overrides);
      EXPECT_EQ(set_in(overrides), std::set{name});
    }
  }
  for (const MethodField& field : fields_of_method()) {
    EXPECT_TRUE(changes().contains(field.option)) << field.option;
  }
}

TEST(ParameterReaders, TablesNameOptionsThatExist) {
  std::set<std::string_view> options;
  for (const MethodField& field : fields_of_method()) {
    options.insert(field.option);
  }
  const auto expect_known = [&](const auto& table) {
    for (const auto& entry : table) {
      for (const std::string_view option : entry.options) {
        EXPECT_TRUE(options.contains(option)) << entry.name << " reads " << option;
      }
      EXPECT_FALSE(entry.description.empty()) << entry.name;
    }
  };
  expect_known(cost_table());
  expect_known(aggregation_table());
}

TEST(ParameterReaders, AreNamedFromTheTables) {
  std::map<std::string_view, std::string> names;
  for (const MethodField& field : fields_of_method()) {
    names[field.option] = names_of(field.readers, field.option);
  }
  EXPECT_EQ(names["truncation"], "the cost truncated");
  EXPECT_EQ(names["alpha"], "the cost gradient (method gradient)");
  EXPECT_EQ(names["sigma-measurement"],
            "the cost contaminated, the aggregation bayes, and local-stopping with "
            "certainty entropy");
  EXPECT_EQ(names["epsilon-measurement"], "the cost contaminated, and the aggregation bayes");
  EXPECT_EQ(names["aggregation-sigma"],
            "the aggregations gaussian and box-cascade (method gradient)");
  EXPECT_EQ(names["final-iterations"],
            "diffusion, membrane, local-stopping and bayes with levels above 1");
  EXPECT_EQ(names["mu"], "the aggregation bayes (method bayes, the presets)");
}

TEST(ParameterReaders, AreThoseWhoseMapsChange) {
  SCOPED_TRACE(sample_name());
  Maps maps;
  const auto rows =
      sampled_rows({static_cast<int>(kCosts.size()), static_cast<int>(kAggregations.size()),
                    static_cast<int>(kSituations.size())});
  // A third of them takes long enough: what reads a parameter is a matter of cost or aggregation.
  const std::size_t step = runs_everything() ? 1 : 3;
  for (std::size_t i = sample_seed() % step; i < rows.size(); i += step) {
    const SampleRow& row = rows[i];
    const MethodParameters before = parameters_of(row);
    ASSERT_TRUE(is_valid(before));
    for (const MethodField& field : fields_of_method()) {
      bool is_changed = false;
      for (const auto& change : changes().at(field.option)) {
        MethodOverrides overrides = as_overrides(before);
        change(overrides);
        MethodParameters after = resolve(MatchMethod::kSsd, overrides);
        if (after.candidate_blocks == before.candidate_blocks && !can_prune(after)) {
          after.candidate_blocks = 0;  // as without the preset that had set it
        }
        if (!is_valid(after) || after == before) {
          continue;
        }
        is_changed = is_changed || !are_equal(maps.of(before), maps.of(after));
      }
      const bool is_expected =
          field.is_read(before) && !is_without_difference(field.option, before);
      EXPECT_EQ(is_changed, is_expected) << field.option << " with " << summary_of(before);
    }
  }
}

TEST(ParameterReaders, WhatNothingReadsIsRefusedUnlessAPresetSetsIt) {
  MatchOptions options;
  EXPECT_EQ(complaint(options), "");
  options.parameters.lambda = 0.1;
  EXPECT_EQ(complaint(options),
            "lambda is set but has no effect with preset balanced (cost census-rays, aggregation "
            "bayes, 7 levels); it is read by diffusion, membrane and local-stopping");
  options.method = MatchMethod::kDiffusion;
  EXPECT_EQ(complaint(options), "");
  options.parameters.edge_weight = 0.2;
  EXPECT_EQ(complaint(options), "");
  options.parameters.edge_weight.reset();
  options.parameters.mu = 0.2;
  EXPECT_THAT(complaint(options),
              HasSubstr("mu is set but has no effect with method diffusion (cost squared, "
                        "aggregation diffusion, 1 level); it is read by the aggregation bayes"));
  // What a preset sets for an aggregation that is replaced is nobody's mistake.
  options = {};
  options.preset = MatchPreset::kQuality;
  options.parameters.aggregation = Aggregation::kMembrane;
  options.parameters.levels = 1;
  EXPECT_EQ(complaint(options), "");
}

TEST(Refinement, WhatNothingReadsIsRefused) {
  std::set<const void*> fields;
  const RefinementOptions defaults;
  MatchOptions options;
  visit_fields(
      [&](const RefinementField& field, const auto& in_force, auto& value) {
        fields.insert(&value);
        options.raw = false;
        value = in_force;
        EXPECT_EQ(complaint(options), "") << field.option;
        options.raw = true;
        EXPECT_EQ(complaint(options),
                  fmt::format("{} is set but has no effect with raw, which leaves all refinement "
                              "out",
                              field.option));
        value.reset();
      },
      defaults, options.refinement);
  EXPECT_EQ(fields.size(), count_fields<RefinementOptions>());
  options = {};
  options.refinement.cross_check = false;
  options.refinement.cross_check_px = 3;
  EXPECT_THAT(complaint(options), HasSubstr("has no effect with cross-check none"));
  options.refinement.cross_check_px.reset();
  options.preset = MatchPreset::kBalanced;
  EXPECT_EQ(complaint(options), "");
  options.refinement.surface_fit_px = 0;
  EXPECT_EQ(complaint(options), "");
  options.refinement.surface_fit_step_px = 2;
  EXPECT_EQ(complaint(options), "surface-fit-step is set but has no effect with surface-fit 0");
  options = {};
  options.refinement.uniform_contrast = 2;
  EXPECT_EQ(complaint(options),
            "uniform-contrast is set but has no effect with a fill other than canonical and "
            "thin-plate");
  options.refinement.fill = Fill::kThinPlate;
  EXPECT_EQ(complaint(options), "");
}

}  // namespace vantage::parameter_readers_test
