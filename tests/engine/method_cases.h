#pragma once

#include "engine/matching/options/match_options.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// A way of matching, and a name for messages.
struct MethodCase {
  std::string name;
  MatchOptions options;  ///< raw, without sub-pixel
};

/// Whether cells are rounded to steps on the way, so that they stay within other bounds of the
/// plain transcription than floats: stored levels and energies in fixed point
/// (coarse_to_fine_test).
inline bool is_stepped(const MethodCase& method) {
  const MethodParameters parameters = method.options.resolved();
  return parameters.levels > 1 || (parameters.prior_smoothing == PriorSmoothing::kMaximum &&
                                   parameters.prior != Prior::kQuadratic);
}

/// What test runners print of a case instead of its bytes.
inline void PrintTo(const MethodCase& method, std::ostream* stream) { *stream << method.name; }

/// The book's methods, and one of every other kind of chain: whatever is different code.
inline std::vector<MethodCase> method_cases(DisparityRange range) {
  struct Row {
    const char* name;
    MatchMethod method;
    MethodOverrides parameters;
  };
  using enum MatchMethod;
  static const Row kRows[] = {
      {"ssd", kSsd, {}},
      {"ssd_valid", kSsd, {.window_px = 5, .border = Border::kValid}},
      {"truncated_box", kSsd, {.cost = MatchCost::kTruncated}},
      {"census_box", kSsd, {.cost = MatchCost::kCensus, .window_px = 5}},
      {"ray_census_cascade",
       kSsd,
       {.cost = MatchCost::kRayCensus, .aggregation = Aggregation::kBoxCascade}},
      {"birchfield_tomasi_none",
       kSsd,
       {.cost = MatchCost::kBirchfieldTomasi, .aggregation = Aggregation::kNone}},
      {"absolute_gaussian",
       kSsd,
       {.cost = MatchCost::kAbsolute, .aggregation = Aggregation::kGaussian}},
      {"gradient", kGradient, {}},
      {"gradient_octagon",
       kGradient,
       {.norm = GradientNorm::kOctagon, .gradient = GradientFilter::kSimoncelli5}},
      {"diffusion", kDiffusion, {}},
      {"membrane", kMembrane, {}},
      {"local_stopping_margin", kLocalStopping, {.certainty = Certainty::kMargin}},
      {"local_stopping_entropy", kLocalStopping, {.certainty = Certainty::kEntropy}},
      {"local_stopping_evidence",
       kLocalStopping,
       {.cost = MatchCost::kGradient, .certainty = Certainty::kEntropy}},
      {"bayes_planar", kBayes, {.sigma_prior = 0.1}},
      {"bayes", kBayes, {.sigma_prior = 0.4}},
      {"bayes_general", kBayes, {.mu = 0.3}},
      {"bayes_impulse", kBayes, {.prior = Prior::kImpulse}},
      {"bayes_quadratic", kBayes, {.prior = Prior::kQuadratic}},
      {"bayes_quadratic_maximum_levels",
       kBayes,
       {.iterations = 3,
        .levels = 3,
        .final_iterations = 2,
        .prior = Prior::kQuadratic,
        .prior_smoothing = PriorSmoothing::kMaximum,
        .edge_weight = 0.2}},
      {"bayes_levels", kBayes, {.iterations = 3, .levels = 4}},
      {"bayes_edges", kBayes, {.sigma_prior = 0.4, .edge_weight = 0.2, .edge_diffusion = 4}},
      {"bayes_maximum", kBayes, {.sigma_prior = 0.8, .prior_smoothing = PriorSmoothing::kMaximum}},
      {"bayes_maximum_levels",
       kBayes,
       {.cost = MatchCost::kRayCensus,
        .census_thresholds = 3,
        .iterations = 3,
        .levels = 4,
        .final_iterations = 1,
        .epsilon_prior = 5e-6,
        .prior_growth = 1.2,
        .prior_smoothing = PriorSmoothing::kMaximum,
        .level_weight = 0.6,
        .edge_weight = 0.2,
        .edge_diffusion = 2}},
      {"bayes_edges_levels",
       kBayes,
       {.iterations = 3,
        .levels = 4,
        .final_iterations = 2,
        .epsilon_prior = 5e-6,
        .prior_growth = 1.2,
        .level_weight = 0.6,
        .edge_weight = 0.2,
        .edge_contrast = 12}},
      {"membrane_levels", kMembrane, {.iterations = 4, .levels = 3}},
      {"diffusion_levels", kDiffusion, {.iterations = 4, .levels = 3}},
      {"diffusion_edges", kDiffusion, {.edge_weight = 0.1, .edge_diffusion = 3}},
      {"membrane_edges_levels",
       kMembrane,
       {.iterations = 4,
        .levels = 3,
        .final_iterations = 2,
        .edge_weight = 0,
        .edge_contrast = 12,
        .edge_diffusion = 8}},
      {"local_stopping_edges", kLocalStopping, {.edge_weight = 0.2, .edge_diffusion = 20}},
      {"box_levels", kSsd, {.window_px = 5, .levels = 3}},
      {"bayes_of_evidence", kBayes, {.cost = MatchCost::kGradient}},
  };
  std::vector<MethodCase> cases;
  for (const Row& row : kRows) {
    MatchOptions options;
    options.method = row.method;
    options.disparities = range;
    options.raw = true;
    options.parameters = row.parameters;
    options.parameters.subpixel = Subpixel::kNone;
    cases.push_back({row.name, options});
  }
  return cases;
}

}  // namespace test
}  // namespace vantage
