#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "engine/matching/options/match_options.h"

namespace vantage::test {

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
  std::vector<MethodCase> cases;
  const auto add = [&](std::string name, MatchMethod method, void (*set)(MethodOverrides & p)) {
    MatchOptions options;
    options.method = method;
    options.disparities = range;
    options.raw = true;
    options.parameters.subpixel = Subpixel::kNone;
    set(options.parameters);
    cases.push_back({std::move(name), options});
  };
  add("ssd", MatchMethod::kSsd, [](MethodOverrides&) {});
  add("ssd_valid", MatchMethod::kSsd, [](MethodOverrides& p) {
    p.border = Border::kValid;
    p.window_px = 5;
  });
  add("truncated_box", MatchMethod::kSsd,
      [](MethodOverrides& p) { p.cost = MatchCost::kTruncated; });
  add("census_box", MatchMethod::kSsd, [](MethodOverrides& p) {
    p.cost = MatchCost::kCensus;
    p.window_px = 5;
  });
  add("ray_census_cascade", MatchMethod::kSsd, [](MethodOverrides& p) {
    p.cost = MatchCost::kRayCensus;
    p.aggregation = Aggregation::kBoxCascade;
  });
  add("birchfield_tomasi_none", MatchMethod::kSsd, [](MethodOverrides& p) {
    p.cost = MatchCost::kBirchfieldTomasi;
    p.aggregation = Aggregation::kNone;
  });
  add("absolute_gaussian", MatchMethod::kSsd, [](MethodOverrides& p) {
    p.cost = MatchCost::kAbsolute;
    p.aggregation = Aggregation::kGaussian;
  });
  add("gradient", MatchMethod::kGradient, [](MethodOverrides&) {});
  add("gradient_octagon", MatchMethod::kGradient, [](MethodOverrides& p) {
    p.norm = GradientNorm::kOctagon;
    p.gradient = GradientFilter::kSimoncelli5;
  });
  add("diffusion", MatchMethod::kDiffusion, [](MethodOverrides&) {});
  add("membrane", MatchMethod::kMembrane, [](MethodOverrides&) {});
  add("local_stopping_margin", MatchMethod::kLocalStopping,
      [](MethodOverrides& p) { p.certainty = Certainty::kMargin; });
  add("local_stopping_entropy", MatchMethod::kLocalStopping,
      [](MethodOverrides& p) { p.certainty = Certainty::kEntropy; });
  add("local_stopping_evidence", MatchMethod::kLocalStopping, [](MethodOverrides& p) {
    p.cost = MatchCost::kGradient;
    p.certainty = Certainty::kEntropy;
  });
  add("bayes_planar", MatchMethod::kBayes, [](MethodOverrides& p) { p.sigma_prior = 0.1; });
  add("bayes", MatchMethod::kBayes, [](MethodOverrides& p) { p.sigma_prior = 0.4; });
  add("bayes_general", MatchMethod::kBayes, [](MethodOverrides& p) { p.mu = 0.3; });
  add("bayes_impulse", MatchMethod::kBayes, [](MethodOverrides& p) { p.prior = Prior::kImpulse; });
  add("bayes_quadratic", MatchMethod::kBayes,
      [](MethodOverrides& p) { p.prior = Prior::kQuadratic; });
  add("bayes_quadratic_maximum_levels", MatchMethod::kBayes, [](MethodOverrides& p) {
    p.prior = Prior::kQuadratic;
    p.prior_smoothing = PriorSmoothing::kMaximum;
    p.levels = 3;
    p.iterations = 3;
    p.final_iterations = 2;
    p.edge_weight = 0.2;
  });
  add("bayes_levels", MatchMethod::kBayes, [](MethodOverrides& p) {
    p.levels = 4;
    p.iterations = 3;
  });
  add("bayes_edges", MatchMethod::kBayes, [](MethodOverrides& p) {
    p.edge_weight = 0.2;
    p.edge_diffusion = 4;
    p.sigma_prior = 0.4;
  });
  add("bayes_maximum", MatchMethod::kBayes, [](MethodOverrides& p) {
    p.prior_smoothing = PriorSmoothing::kMaximum;
    p.sigma_prior = 0.8;
  });
  add("bayes_maximum_levels", MatchMethod::kBayes, [](MethodOverrides& p) {
    p.prior_smoothing = PriorSmoothing::kMaximum;
    p.cost = MatchCost::kRayCensus;
    p.census_thresholds = 3;
    p.levels = 4;
    p.iterations = 3;
    p.final_iterations = 1;
    p.edge_weight = 0.2;
    p.edge_diffusion = 2;
    p.prior_growth = 1.2;
    p.level_weight = 0.6;
    p.epsilon_prior = 5e-6;
  });
  add("bayes_edges_levels", MatchMethod::kBayes, [](MethodOverrides& p) {
    p.levels = 4;
    p.iterations = 3;
    p.final_iterations = 2;
    p.edge_weight = 0.2;
    p.edge_contrast = 12;
    p.prior_growth = 1.2;
    p.level_weight = 0.6;
    p.epsilon_prior = 5e-6;
  });
  add("membrane_levels", MatchMethod::kMembrane, [](MethodOverrides& p) {
    p.levels = 3;
    p.iterations = 4;
  });
  add("diffusion_levels", MatchMethod::kDiffusion, [](MethodOverrides& p) {
    p.levels = 3;
    p.iterations = 4;
  });
  add("diffusion_edges", MatchMethod::kDiffusion, [](MethodOverrides& p) {
    p.edge_weight = 0.1;
    p.edge_diffusion = 3;
  });
  add("membrane_edges_levels", MatchMethod::kMembrane, [](MethodOverrides& p) {
    p.levels = 3;
    p.iterations = 4;
    p.final_iterations = 2;
    p.edge_weight = 0;
    p.edge_contrast = 12;
    p.edge_diffusion = 8;
  });
  add("local_stopping_edges", MatchMethod::kLocalStopping, [](MethodOverrides& p) {
    p.edge_weight = 0.2;
    p.edge_diffusion = 20;
  });
  add("box_levels", MatchMethod::kSsd, [](MethodOverrides& p) {
    p.levels = 3;
    p.window_px = 5;
  });
  add("bayes_of_evidence", MatchMethod::kBayes,
      [](MethodOverrides& p) { p.cost = MatchCost::kGradient; });
  return cases;
}

}  // namespace vantage::test
