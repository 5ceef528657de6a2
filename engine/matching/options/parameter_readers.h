#pragma once

#include <string_view>

#include "engine/matching/options/method_parameters.h"

namespace vantage {

/// What reads a parameter of a method. What costs, aggregations and levels read is said nowhere
/// else.
struct ParameterReaders {
  std::string_view names;  ///< for messages: "the aggregation box"
  /// Whether results of these parameters can depend on it.
  bool (*are_in_force)(const MethodParameters& in_force);
};

namespace readers {

inline bool is_bayes(const MethodParameters& p) { return p.aggregation == Aggregation::kBayes; }
inline bool is_iterative(const MethodParameters& p) {
  return p.aggregation == Aggregation::kDiffusion || p.aggregation == Aggregation::kMembrane ||
         p.aggregation == Aggregation::kLocalStopping || is_bayes(p);
}
template <Aggregation aggregation>
bool aggregates_by(const MethodParameters& p) {
  return p.aggregation == aggregation;
}
template <MatchCost cost>
bool costs_by(const MethodParameters& p) {
  return p.cost == cost;
}

inline constexpr ParameterReaders kAll = {"every method",
                                          [](const MethodParameters&) { return true; }};

// Costs.
inline constexpr ParameterReaders kTruncated = {"the cost truncated",
                                                costs_by<MatchCost::kTruncated>};
inline constexpr ParameterReaders kRayCensus = {"the cost census-rays",
                                                costs_by<MatchCost::kRayCensus>};
inline constexpr ParameterReaders kCombined = {"the cost combined", costs_by<MatchCost::kCombined>};
inline constexpr ParameterReaders kGradient = {"the cost gradient (method gradient)",
                                               costs_by<MatchCost::kGradient>};
inline constexpr ParameterReaders kExposure = {
    "every cost but census and census-rays, whose codes no exposure changes",
    [](const MethodParameters& p) { return !is_census(p.cost); }};
inline constexpr ParameterReaders kSigmaMeasurement = {
    "the costs contaminated and combined, the aggregation bayes, and local-stopping with certainty "
    "entropy",
    uses_sigma_measurement};
inline constexpr ParameterReaders kEpsilonMeasurement = {
    "the costs contaminated and combined, and the aggregation bayes",
    [](const MethodParameters& p) {
      return p.cost == MatchCost::kContaminated || p.cost == MatchCost::kCombined || is_bayes(p);
    }};

// Aggregations.
inline constexpr ParameterReaders kBox = {
    "the aggregation box (method ssd), which alone has windows", aggregates_by<Aggregation::kBox>};
inline constexpr ParameterReaders kGaussians = {
    "the aggregations gaussian and box-cascade (method gradient)", [](const MethodParameters& p) {
      return p.aggregation == Aggregation::kGaussian || p.aggregation == Aggregation::kBoxCascade;
    }};
inline constexpr ParameterReaders kIterative = {"diffusion, membrane, local-stopping and bayes",
                                                is_iterative};
inline constexpr ParameterReaders kIterativeWithLevels = {
    "diffusion, membrane, local-stopping and bayes with levels above 1",
    [](const MethodParameters& p) { return is_iterative(p) && p.levels > 1; }};
inline constexpr ParameterReaders kSteps = {
    "diffusion, membrane and local-stopping",
    [](const MethodParameters& p) { return is_iterative(p) && !is_bayes(p); }};
inline constexpr ParameterReaders kMembrane = {"membrane", aggregates_by<Aggregation::kMembrane>};
inline constexpr ParameterReaders kLocalStopping = {"local-stopping",
                                                    aggregates_by<Aggregation::kLocalStopping>};
inline constexpr ParameterReaders kBayes = {"the aggregation bayes (method bayes, the presets)",
                                            is_bayes};
inline constexpr ParameterReaders kBayesWithLevels = {
    "the aggregation bayes (method bayes, the presets) with levels above 1",
    [](const MethodParameters& p) { return is_bayes(p) && p.levels > 1; }};
/// That candidate_blocks is 0 where it can only be 0 counts as read.
inline constexpr ParameterReaders kCandidateBlocks = {
    kBayesWithLevels.names,
    [](const MethodParameters& p) { return p.candidate_blocks == 0 || can_prune(p); }};
inline constexpr ParameterReaders kPrunedLevels = {
    "the aggregation bayes with levels above 1 and candidate-blocks above 0 (the presets)",
    [](const MethodParameters& p) { return p.candidate_blocks > 0 && can_prune(p); }};
inline constexpr ParameterReaders kEdges = {
    "the aggregation bayes with edge-weight below 1 (the presets)", uses_edge_weights};

}  // namespace readers
}  // namespace vantage
