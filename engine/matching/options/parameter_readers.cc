#include "engine/matching/options/parameter_readers.h"

#include <fmt/format.h>

#include <array>

#include "engine/error.h"
#include "engine/matching/options/method_names.h"

namespace vantage {
namespace {

template <auto... Fields>
bool is_any_set(const MethodOverrides& overrides) {
  return ((overrides.*Fields).has_value() || ...);
}

bool is_always_read(const MethodParameters& /*in_force*/) { return true; }

bool is_iterative(const MethodParameters& p) {
  return p.aggregation == Aggregation::kDiffusion || p.aggregation == Aggregation::kMembrane ||
         p.aggregation == Aggregation::kLocalStopping || p.aggregation == Aggregation::kBayes;
}
bool has_steps(const MethodParameters& p) {
  return is_iterative(p) && p.aggregation != Aggregation::kBayes;
}

template <Aggregation aggregation>
bool aggregates_by(const MethodParameters& p) {
  return p.aggregation == aggregation;
}
template <MatchCost cost>
bool costs_by(const MethodParameters& p) {
  return p.cost == cost;
}

bool is_bayes(const MethodParameters& p) { return p.aggregation == Aggregation::kBayes; }
bool is_bayes_with_levels(const MethodParameters& p) { return is_bayes(p) && p.levels > 1; }

constexpr std::string_view kAll = "every method";
constexpr std::string_view kBayesReads = "the aggregation bayes (method bayes, the presets)";
constexpr std::string_view kBayesWithLevelsReads =
    "the aggregation bayes (method bayes, the presets) with levels above 1";
constexpr std::string_view kGradientReads = "the cost gradient (method gradient)";

constexpr std::array kReaders = {
    ParameterReaders{"cost", kAll, is_any_set<&MethodOverrides::cost>, is_always_read},
    ParameterReaders{"colour", kAll, is_any_set<&MethodOverrides::colour>, is_always_read},
    ParameterReaders{"truncation", "the cost truncated", is_any_set<&MethodOverrides::truncation>,
                     costs_by<MatchCost::kTruncated>},
    ParameterReaders{"match-exposure",
                     "every cost but census and census-rays, whose codes no exposure changes",
                     is_any_set<&MethodOverrides::match_exposure>,
                     [](const MethodParameters& p) { return !is_census(p.cost); }},
    ParameterReaders{"sigma-measurement",
                     "the costs contaminated and combined, the aggregation bayes, and "
                     "local-stopping with certainty entropy",
                     is_any_set<&MethodOverrides::sigma_measurement,
                                &MethodOverrides::estimate_sigma_measurement>,
                     uses_sigma_measurement},
    ParameterReaders{"epsilon-measurement",
                     "the costs contaminated and combined, and the aggregation bayes",
                     is_any_set<&MethodOverrides::epsilon_measurement>,
                     [](const MethodParameters& p) {
                       return p.cost == MatchCost::kContaminated ||
                              p.cost == MatchCost::kCombined || is_bayes(p);
                     }},
    ParameterReaders{"census-thresholds", "the cost census-rays",
                     is_any_set<&MethodOverrides::census_thresholds>,
                     costs_by<MatchCost::kRayCensus>},
    ParameterReaders{"sigma-census", "the cost combined",
                     is_any_set<&MethodOverrides::sigma_census>, costs_by<MatchCost::kCombined>},
    ParameterReaders{"sigma-gradient", "the cost combined",
                     is_any_set<&MethodOverrides::sigma_gradient>, costs_by<MatchCost::kCombined>},
    ParameterReaders{"alpha", kGradientReads, is_any_set<&MethodOverrides::alpha>,
                     costs_by<MatchCost::kGradient>},
    ParameterReaders{"norm", kGradientReads, is_any_set<&MethodOverrides::norm>,
                     costs_by<MatchCost::kGradient>},
    ParameterReaders{"gradient", kGradientReads, is_any_set<&MethodOverrides::gradient>,
                     costs_by<MatchCost::kGradient>},
    ParameterReaders{"prefilter", kGradientReads, is_any_set<&MethodOverrides::prefilter>,
                     costs_by<MatchCost::kGradient>},
    ParameterReaders{"aggregate", kAll, is_any_set<&MethodOverrides::aggregation>, is_always_read},
    ParameterReaders{"window", "the aggregation box (method ssd), which alone has windows",
                     is_any_set<&MethodOverrides::window_px>, aggregates_by<Aggregation::kBox>},
    ParameterReaders{"border", "the aggregation box (method ssd), which alone has windows",
                     is_any_set<&MethodOverrides::border>, aggregates_by<Aggregation::kBox>},
    ParameterReaders{"aggregation-sigma",
                     "the aggregations gaussian and box-cascade (method gradient)",
                     is_any_set<&MethodOverrides::aggregation_sigma_px>,
                     [](const MethodParameters& p) {
                       return p.aggregation == Aggregation::kGaussian ||
                              p.aggregation == Aggregation::kBoxCascade;
                     }},
    ParameterReaders{"iterations", "diffusion, membrane, local-stopping and bayes",
                     is_any_set<&MethodOverrides::iterations>, is_iterative},
    ParameterReaders{"levels", kAll, is_any_set<&MethodOverrides::levels>, is_always_read},
    ParameterReaders{
        "candidate-blocks", kBayesWithLevelsReads, is_any_set<&MethodOverrides::candidate_blocks>,
        [](const MethodParameters& p) { return p.candidate_blocks == 0 || can_prune(p); }},
    ParameterReaders{
        "pruned-levels",
        "the aggregation bayes with levels above 1 and candidate-blocks above 0 (the "
        "presets)",
        is_any_set<&MethodOverrides::pruned_levels>,
        [](const MethodParameters& p) { return p.candidate_blocks > 0 && can_prune(p); }},
    ParameterReaders{"final-iterations",
                     "diffusion, membrane, local-stopping and bayes with levels above 1",
                     is_any_set<&MethodOverrides::final_iterations>,
                     [](const MethodParameters& p) { return is_iterative(p) && p.levels > 1; }},
    ParameterReaders{"lambda", "diffusion, membrane and local-stopping",
                     is_any_set<&MethodOverrides::lambda>, has_steps},
    ParameterReaders{"beta", "membrane", is_any_set<&MethodOverrides::beta>,
                     aggregates_by<Aggregation::kMembrane>},
    ParameterReaders{"certainty", "local-stopping", is_any_set<&MethodOverrides::certainty>,
                     aggregates_by<Aggregation::kLocalStopping>},
    ParameterReaders{"mu", kBayesReads, is_any_set<&MethodOverrides::mu>, is_bayes},
    ParameterReaders{"sigma-prior", kBayesReads, is_any_set<&MethodOverrides::sigma_prior>,
                     is_bayes},
    ParameterReaders{"epsilon-prior", kBayesReads, is_any_set<&MethodOverrides::epsilon_prior>,
                     is_bayes},
    ParameterReaders{"prior-growth", kBayesWithLevelsReads,
                     is_any_set<&MethodOverrides::prior_growth>, is_bayes_with_levels},
    ParameterReaders{"prior-smoothing", kBayesReads, is_any_set<&MethodOverrides::prior_smoothing>,
                     is_bayes},
    ParameterReaders{"level-weight", kBayesWithLevelsReads,
                     is_any_set<&MethodOverrides::level_weight>, is_bayes_with_levels},
    ParameterReaders{"edge-weight", kBayesReads, is_any_set<&MethodOverrides::edge_weight>,
                     is_bayes},
    ParameterReaders{"edge-contrast",
                     "the aggregation bayes with edge-weight below 1 (the presets)",
                     is_any_set<&MethodOverrides::edge_contrast>,
                     [](const MethodParameters& p) { return uses_edge_weights(p); }},
    ParameterReaders{"subpixel", kAll, is_any_set<&MethodOverrides::subpixel>, is_always_read},
};

}  // namespace

std::span<const ParameterReaders> parameter_readers() { return kReaders; }

void require_read(const MethodOverrides& overrides, const MethodParameters& in_force,
                  std::string_view chosen) {
  for (const ParameterReaders& parameter : kReaders) {
    if (parameter.is_set(overrides) && !parameter.is_read(in_force)) {
      throw UsageError(fmt::format("{} is set but has no effect with {} ({}); it is read by {}",
                                   parameter.name, chosen, summary_of(in_force),
                                   parameter.readers));
    }
  }
}

}  // namespace vantage
