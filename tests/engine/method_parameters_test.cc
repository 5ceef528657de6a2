#include "engine/matching/options/method_rules.h"

#include "engine/matching/costs/cost_table.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/options/match_presets.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/option_complaint.h"

namespace vantage::method_parameters_test {

TEST(MethodParameters, AreTheBooks) {
  // EQUATIONS §1–§3.
  const MethodParameters ssd = book_parameters(MatchMethod::kSsd);
  EXPECT_EQ(ssd.cost, MatchCost::kSquared);
  EXPECT_EQ(ssd.aggregation, Aggregation::kBox);
  EXPECT_EQ(ssd.border, Border::kClip);
  const MethodParameters gradient = book_parameters(MatchMethod::kGradient);
  EXPECT_EQ(gradient.cost, MatchCost::kGradient);
  EXPECT_EQ(gradient.aggregation, Aggregation::kBoxCascade);
  EXPECT_EQ(gradient.aggregation_sigma_px, 2);
  EXPECT_EQ(gradient.alpha, 1);
  EXPECT_EQ(gradient.norm, GradientNorm::kL2);
  EXPECT_EQ(gradient.gradient, GradientFilter::kCentral);
  EXPECT_TRUE(gradient.prefilter);
  const MethodParameters diffusion = book_parameters(MatchMethod::kDiffusion);
  EXPECT_EQ(diffusion.aggregation, Aggregation::kDiffusion);
  EXPECT_EQ(diffusion.lambda, 0.15);
  const MethodParameters membrane = book_parameters(MatchMethod::kMembrane);
  EXPECT_EQ(membrane.aggregation, Aggregation::kMembrane);
  EXPECT_EQ(membrane.beta, 0.5);
  EXPECT_EQ(book_parameters(MatchMethod::kLocalStopping).certainty, Certainty::kMargin);
  const MethodParameters bayes = book_parameters(MatchMethod::kBayes);
  EXPECT_EQ(bayes.cost, MatchCost::kContaminated);
  EXPECT_EQ(bayes.aggregation, Aggregation::kBayes);
  EXPECT_EQ(bayes.mu, 0.5);
  EXPECT_EQ(bayes.epsilon_prior, 0.01);
  EXPECT_EQ(bayes.epsilon_measurement, 0.1);
  EXPECT_EQ(bayes.iterations, 10);
}

TEST(MethodParameters, OverridesGoBeforePresetsBeforeTheBook) {
  MatchOptions options;
  options.preset = MatchPreset::kQuality;
  const PresetSettings preset = preset_settings(MatchPreset::kQuality);
  EXPECT_EQ(options.resolved(), resolve(preset.method, preset.parameters));
  EXPECT_EQ(options.resolved_refinement().cross_check_px, *preset.refinement.cross_check_px);
  options.parameters.iterations = 77;
  options.parameters.aggregation = Aggregation::kMembrane;
  options.refinement.speckle_size_px = 3;
  options.refinement.cross_check = false;
  const MethodParameters resolved = options.resolved();
  EXPECT_EQ(resolved.iterations, 77);
  EXPECT_EQ(resolved.aggregation, Aggregation::kMembrane);
  EXPECT_EQ(resolved.cost, MatchCost::kRayCensus);  // the preset's goes with a membrane too
  EXPECT_EQ(resolved.levels, *preset.parameters.levels);
  EXPECT_EQ(resolved.candidate_blocks, 0);  // which cannot be pruned
  EXPECT_EQ(complaint(options), "");
  options.disparities_y = DisparityRange{-1, 1};
  EXPECT_EQ(options.resolved().levels, *preset.parameters.levels);  // in two dimensions, too
  EXPECT_EQ(complaint(options), "");
  EXPECT_EQ(resolved.sigma_measurement, *preset.parameters.sigma_measurement);
  EXPECT_EQ(options.resolved_refinement().speckle_size_px, 3);
  EXPECT_FALSE(options.resolved_refinement().cross_check);
  EXPECT_EQ(options.resolved_refinement().cross_check_px, *preset.refinement.cross_check_px);
}

TEST(MethodParameters, PresetsSearchAsManyPixelsWithCandidatesBetweenThem) {
  MatchOptions options;
  options.preset = MatchPreset::kBalanced;
  const int blocks = options.resolved().candidate_blocks;
  ASSERT_EQ(blocks, 3);
  options.parameters.candidate_step_px = 0.5;
  EXPECT_EQ(options.resolved().candidate_blocks, 2 * blocks);
  options.parameters.candidate_step_px = 0.25;
  EXPECT_EQ(options.resolved().candidate_blocks, kMaxCandidateBlocks);
  options.parameters.candidate_blocks = 2;
  EXPECT_EQ(options.resolved().candidate_blocks, 2);
}

TEST(MethodParameters, CostFollowsTheAggregationUnlessItIsSet) {
  MatchOptions options;
  options.parameters.aggregation = Aggregation::kBayes;
  EXPECT_EQ(options.resolved().cost, MatchCost::kContaminated);
  options.parameters.cost = MatchCost::kCensus;
  EXPECT_EQ(options.resolved().cost, MatchCost::kCensus);
  options = {};
  options.method = MatchMethod::kGradient;
  options.parameters.aggregation = Aggregation::kBayes;
  EXPECT_EQ(options.resolved().cost, MatchCost::kGradient);
}

TEST(MethodParameters, APresetsNoiseIsOfItsOwnCost) {
  const double of_the_book = book_parameters(MatchMethod::kBayes).sigma_measurement;
  MatchOptions options;
  options.preset = MatchPreset::kBalanced;
  options.parameters.cost = MatchCost::kRayCensus;
  EXPECT_NE(options.resolved().sigma_measurement, of_the_book);
  options.parameters.cost = MatchCost::kContaminated;
  EXPECT_EQ(options.resolved().sigma_measurement, of_the_book);
}

TEST(MethodParameters, WithoutAnyChoiceTheyAreThoseOfBalanced) {
  MatchOptions balanced;
  balanced.preset = MatchPreset::kBalanced;
  MatchOptions options;
  EXPECT_EQ(options.resolved(), balanced.resolved());
  EXPECT_EQ(options.resolved_refinement(), balanced.resolved_refinement());
  EXPECT_EQ(options.fully_resolved().method, MatchMethod::kBayes);
  options.parameters.levels = balanced.parameters.levels = 3;
  EXPECT_EQ(options.resolved(), balanced.resolved());

  const MethodParameters ssd = book_parameters(MatchMethod::kSsd);
  options = {};
  options.disparities_y = {0, 1};
  EXPECT_EQ(options.resolved(), ssd);
  EXPECT_EQ(options.fully_resolved().method, MatchMethod::kSsd);
  // Another cost in the preset's place leaves all else as it is.
  options = balanced = {};
  balanced.preset = MatchPreset::kBalanced;
  options.parameters.cost = balanced.parameters.cost = MatchCost::kCensus;
  EXPECT_EQ(options.resolved(), balanced.resolved());
  EXPECT_EQ(options.resolved_refinement(), balanced.resolved_refinement());
  options = {};
  options.parameters.aggregation = Aggregation::kBox;
  EXPECT_EQ(options.resolved(), ssd);
  EXPECT_EQ(options.resolved_refinement().fill, Fill::kConstant);
}

TEST(MethodParameters, PresetsAreValidAndNotCombinedWithMethods) {
  for (const MatchPreset preset :
       {MatchPreset::kRealtime, MatchPreset::kBalanced, MatchPreset::kQuality}) {
    MatchOptions options;
    options.preset = preset;
    EXPECT_EQ(complaint(options), "");
    options.method = MatchMethod::kBayes;
    EXPECT_THAT(complaint(options), HasSubstr("method and preset are both set"));
  }
}

TEST(MethodParameters, SpelledOutIsTheSameWithoutPreset) {
  MatchOptions options;
  options.preset = MatchPreset::kQuality;
  options.disparities = {-7, 90};
  options.parameters.mu = 0.25;
  options.refinement.fill = Fill::kLinear;
  const MatchOptions fully_resolved = options.fully_resolved();
  EXPECT_FALSE(fully_resolved.preset.has_value());
  EXPECT_EQ(fully_resolved.resolved(), options.resolved());
  EXPECT_EQ(fully_resolved.resolved_refinement(), options.resolved_refinement());
  // Nothing is left to the defaults of a method or of the range.
  MatchOptions other = fully_resolved;
  other.method = MatchMethod::kGradient;
  other.disparities = {0, 1};
  EXPECT_EQ(other.resolved(), options.resolved());
  EXPECT_EQ(other.resolved_refinement(), options.resolved_refinement());
}

TEST(Refinement, DefaultsDependOnRangeAndCost) {
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.disparities = {0, 59};
  EXPECT_EQ(options.resolved_refinement().cross_check_px, 4);
  EXPECT_FALSE(uses_confidence(options.resolved_refinement()));
  EXPECT_EQ(options.resolved_refinement().fill, Fill::kConstant);
  options.disparities = {0, 5};
  EXPECT_EQ(options.resolved_refinement().cross_check_px, 1);
  options.method = MatchMethod::kGradient;
  EXPECT_TRUE(uses_confidence(options.resolved_refinement()));
  EXPECT_EQ(options.resolved_refinement().confidence_threshold, 0);
  options.refinement.confidence_threshold = -std::numeric_limits<double>::infinity();
  EXPECT_FALSE(uses_confidence(options.resolved_refinement()));
}

struct Bound {
  std::string name;
  std::function<void(MatchOptions&, double)> set;
  std::vector<double> good;
  std::vector<double> bad;
  std::string says;  ///< the limit, as the message has it
  MatchMethod method = MatchMethod::kSsd;
  /// What makes the method read the field.
  std::function<void(MethodOverrides&)> needs = {};
};

void several_levels(MethodOverrides& parameters) { parameters.levels = 2; }
void scanlines(MethodOverrides& parameters) { parameters.selection = Selection::kScanline; }
void both_images(MethodOverrides& parameters) { parameters.selection = Selection::kSymmetric; }
void pruned(MethodOverrides& parameters) {
  parameters.levels = 3;
  parameters.candidate_blocks = 2;
  parameters.prior_smoothing = PriorSmoothing::kMaximum;
}
void edges(MethodOverrides& parameters) { parameters.edge_weight = 0.5; }
template <MatchCost cost>
void costs_by(MethodOverrides& parameters) {
  parameters.cost = cost;
}

template <typename T>
Bound bound(std::string name, std::optional<T> MethodOverrides::*field, std::vector<double> good,
            std::vector<double> bad, std::string says, MatchMethod method = MatchMethod::kSsd,
            std::function<void(MethodOverrides&)> needs = {}) {
  return {std::move(name),
          [=](MatchOptions& options, double value) {
            options.parameters.*field = static_cast<T>(value);
          },
          std::move(good),
          std::move(bad),
          std::move(says),
          method,
          std::move(needs)};
}
template <typename T>
Bound bound(std::string name, std::optional<T> RefinementOverrides::*field,
            std::vector<double> good, std::vector<double> bad, std::string says) {
  return {std::move(name),
          [=](MatchOptions& options, double value) {
            options.refinement.*field = static_cast<T>(value);
          },
          std::move(good), std::move(bad), std::move(says)};
}

TEST(MethodParameters, DifferFromLevelToLevel) {
  MethodOverrides overrides;
  overrides.iterations = 5;
  overrides.levels = 3;
  overrides.sigma_prior = 0.5;
  overrides.prior_growth = 1.5;
  const auto at = [&overrides](int level) {
    return at_level(resolve(MatchMethod::kBayes, overrides), level);
  };
  EXPECT_EQ(at(0).iterations, 5);  // unless the last are asked for
  overrides.final_iterations = 2;
  EXPECT_EQ(at(0).iterations, 2);
  EXPECT_EQ(at(1).iterations, 5);
  EXPECT_EQ(at(0).sigma_prior, 0.5);
  EXPECT_EQ(at(2).sigma_prior, 0.5 * 1.5 * 1.5);
  overrides.levels = 1;
  EXPECT_EQ(at(0).iterations, 5);
}

TEST(MatchOptions, EveryBoundIsNamedInItsMessage) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  using P = MethodOverrides;
  using R = RefinementOverrides;
  const std::vector<Bound> bounds = {
      bound("window", &P::window_px, {1, 3, 181}, {-1, 0, 2, 182, 183}, "odd number from 1 to 181"),
      bound("aggregation-sigma", &P::aggregation_sigma_px, {0.5, 16}, {0.49, 16.1, kNan},
            "from 0.5 to 16", MatchMethod::kGradient),
      bound("iterations", &P::iterations, {0, 10000}, {-1, 10001}, "from 0 to 10000",
            MatchMethod::kDiffusion),
      bound("final-iterations", &P::final_iterations, {0, 10000}, {-1, 10001}, "from 0 to 10000",
            MatchMethod::kMembrane, several_levels),
      bound("prior-growth", &P::prior_growth, {1, 4}, {0.99, 4.01, kNan}, "from 1 to 4",
            MatchMethod::kBayes, several_levels),
      bound("level-weight", &P::level_weight, {0.001, 1}, {0, -0.1, 1.001, kNan},
            "above 0 and at most 1", MatchMethod::kBayes, several_levels),
      bound("slant-penalty", &P::slant_penalty, {0, 0.5, kInfinity}, {-0.01, kNan},
            "of at least 0, or none", MatchMethod::kBayes, several_levels),
      bound("edge-weight", &P::edge_weight, {0, 1}, {-0.01, 1.01, kNan}, "from 0 to 1",
            MatchMethod::kBayes),
      bound("edge-contrast", &P::edge_contrast, {0.01, 255}, {0, -1, kNan, kInfinity}, "above 0",
            MatchMethod::kBayes, edges),
      bound("edge-diffusion", &P::edge_diffusion, {0, 1000}, {-1, 1001}, "from 0 to 1000",
            MatchMethod::kMembrane, edges),
      bound("jump-penalty", &P::jump_penalty, {0, 1000}, {-0.01, kNan, kInfinity}, "of at least 0",
            MatchMethod::kSsd, scanlines),
      bound("jump-limit", &P::jump_limit, {0, 1000, kInfinity}, {-0.01, kNan},
            "at least 0, or none", MatchMethod::kSsd, scanlines),
      bound("occlusion-penalty", &P::occlusion_penalty, {0.01, 1000}, {0, -0.01, kNan, kInfinity},
            "a number above 0", MatchMethod::kSsd, both_images),
      bound("levels", &P::levels, {1, 10}, {-1, 0, 11}, "from 1 to 10"),
      bound("candidate-blocks", &P::candidate_blocks, {0}, {-1, 9}, "(all candidates) to 8"),
      bound("window-levels", &P::window_levels, {0}, {-1, 2}, "0 or 1"),
      bound("census-thresholds", &P::census_thresholds, {1, 3}, {-1, 0, 2, 4}, "1 or 3",
            MatchMethod::kSsd, costs_by<MatchCost::kRayCensus>),
      bound("pruned-levels", &P::pruned_levels, {1, 10}, {-1, 0, 11}, "from 1 to 10",
            MatchMethod::kBayes, pruned),
      bound("lambda", &P::lambda, {0.01, 0.249}, {0, -1, 0.25, kNan}, "below 0.25",
            MatchMethod::kDiffusion),
      bound("lambda", &P::lambda, {0.01, 0.249}, {0, 0.25, kNan}, "below 0.25",
            MatchMethod::kLocalStopping),
      bound("lambda", &P::lambda, {0.01, 1 / 4.5}, {0, 0.2223, kNan}, "1/(4 + beta) = 0.2222",
            MatchMethod::kMembrane),
      bound("beta", &P::beta, {0, 2.5}, {-0.1, kNan, kInfinity}, "at least 0",
            MatchMethod::kMembrane),
      bound("mu", &P::mu, {0.01, 1}, {0, 1.01, kNan}, "above 0 and at most 1", MatchMethod::kBayes),
      bound("candidate-step", &P::candidate_step_px, {1, 0.5, 0.25}, {0, 2, -1, 0.3, kNan},
            "1, 0.5 or 0.25 pixels", MatchMethod::kSsd),
      bound("sigma-prior", &P::sigma_prior, {0.01, 9}, {0, -1, kNan, kInfinity}, "above 0",
            MatchMethod::kBayes),
      bound("epsilon-prior", &P::epsilon_prior, {0.01, 0.99}, {0, 1, -1, kNan}, "between 0 and 1",
            MatchMethod::kBayes),
      bound("sigma-measurement", &P::sigma_measurement, {0.01, 99}, {0, -1, kNan, kInfinity},
            "above 0", MatchMethod::kBayes),
      bound("epsilon-measurement", &P::epsilon_measurement, {0.01, 0.99}, {0, 1, kNan},
            "between 0 and 1", MatchMethod::kBayes),
      bound("truncation", &P::truncation, {0.1, 255}, {0, -1, kNan, kInfinity}, "above 0",
            MatchMethod::kSsd, costs_by<MatchCost::kTruncated>),
      bound("alpha", &P::alpha, {0, 3}, {-0.1, kNan, kInfinity}, "at least 0",
            MatchMethod::kGradient),
      bound("edge-snapping", &R::edge_snapping_px, {0, 16}, {-1, 17}, "from 0 to 16"),
      bound("cross-check", &R::cross_check_px, {1, 100}, {0.99, 0, kNan, kInfinity}, "at least 1"),
      bound("confidence-threshold", &R::confidence_threshold, {-5, 0, 5, -kInfinity},
            {kNan, kInfinity}, "finite"),
      bound("speckle-size", &R::speckle_size_px, {0, 1000}, {-1}, "at least 0"),
      bound("surface-fit", &R::surface_fit_px, {0, 1, 16}, {-1, 17}, "from 0 to 16"),
      bound("surface-fit-step", &R::surface_fit_step_px, {1}, {0, 3}, "1 or 2"),
      bound("uniform-contrast", &R::uniform_contrast, {1}, {-0.5, kNan, kInfinity},
            "a number of grey levels, at least 0"),
  };
  for (const Bound& row : bounds) {
    const auto complaint_about = [&](double value) {
      MatchOptions options;
      options.method = row.method;
      if (row.needs) {
        row.needs(options.parameters);
      }
      row.set(options, value);
      return complaint(options);
    };
    for (const double value : row.good) {
      EXPECT_EQ(complaint_about(value), "") << row.name << ' ' << value;
    }
    for (const double value : row.bad) {
      EXPECT_THAT(complaint_about(value), HasSubstr(row.name + " is ")) << value;
      EXPECT_THAT(complaint_about(value), HasSubstr(row.says)) << row.name << ' ' << value;
    }
  }
}

TEST(MatchOptions, Candidates) {
  MatchOptions options;
  options.disparities = {0, 4095};
  EXPECT_EQ(complaint(options), "");
  options.disparities = {0, 4096};
  EXPECT_THAT(complaint(options), HasSubstr("4097 candidates"));
  EXPECT_THAT(complaint(options), HasSubstr("at most 4096"));
  options.disparities = {3, 2};
  EXPECT_THAT(complaint(options), HasSubstr("MIN <= MAX"));
  options.disparities = {std::numeric_limits<int>::min(), std::numeric_limits<int>::max()};
  EXPECT_THAT(complaint(options), HasSubstr("within ±65535"));
  options.disparities = {-65535, -65000};
  EXPECT_EQ(complaint(options), "");

  options.disparities = {0, 255};
  options.disparities_y = {-8, 7};
  EXPECT_EQ(complaint(options), "");
  options.disparities_y = {-8, 8};
  EXPECT_THAT(complaint(options), HasSubstr("disparities-y is -8:8 (4352 candidates"));
  options.disparities_y = {1, 0};
  EXPECT_THAT(complaint(options), HasSubstr("disparities-y is 1:0, expected MIN:MAX"));
  options.disparities_y = {0, 0};
  options.refinement.edge_snapping_px = 4;
  EXPECT_THAT(complaint(options), HasSubstr("expected 0 with disparities-y"));
}

TEST(MatchOptions, NoiseOfEvidenceUnderLocalStoppingFollowsTheFilter) {
  MatchOptions options;
  options.method = MatchMethod::kLocalStopping;
  EXPECT_EQ(options.resolved().sigma_measurement, 5);
  EXPECT_DOUBLE_EQ(entropy_scale(options.resolved()), 1.0 / 50);
  options.parameters.cost = MatchCost::kGradient;
  options.parameters.certainty = Certainty::kEntropy;
  EXPECT_EQ(options.resolved().sigma_measurement, 0.5);
  options.parameters.gradient = GradientFilter::kSobel;
  EXPECT_EQ(options.resolved().sigma_measurement, 2);
  EXPECT_DOUBLE_EQ(entropy_scale(options.resolved()), 1.0 / 2);
  options.parameters.sigma_measurement = 7;
  EXPECT_DOUBLE_EQ(entropy_scale(options.resolved()), 1.0 / 7);
  options.parameters.sigma_measurement.reset();
  options.method = MatchMethod::kBayes;
  options.parameters.certainty.reset();
  EXPECT_EQ(options.resolved().sigma_measurement, 5);
}

TEST(MatchOptions, CombinationsThatMakeNoSenseAreRefusedWithTheReason) {
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.parameters.border = Border::kValid;
  EXPECT_EQ(complaint(options), "");
  for (const Aggregation aggregation :
       {Aggregation::kNone, Aggregation::kGaussian, Aggregation::kBoxCascade,
        Aggregation::kDiffusion, Aggregation::kMembrane, Aggregation::kLocalStopping,
        Aggregation::kBayes}) {
    options.parameters.aggregation = aggregation;
    EXPECT_THAT(complaint(options),
                HasSubstr("border is set but has no effect with method ssd with"));
  }
  options = {};
  options.method = MatchMethod::kLocalStopping;
  options.parameters.cost = MatchCost::kGradient;
  EXPECT_THAT(complaint(options), HasSubstr("expected certainty entropy"));
  options.parameters.certainty = Certainty::kEntropy;
  EXPECT_EQ(complaint(options), "");
}

}  // namespace vantage::method_parameters_test
