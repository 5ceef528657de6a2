#pragma once

#include <string>
#include <string_view>

#include "engine/matching/options/method_rules.h"

namespace vantage {

/// What reads a parameter of a method. The tables of costs and aggregations (cost_table,
/// aggregation_table) list the options that these read; all further conditions are only here.
struct ParameterReaders {
  /// For messages. {costs}: those that read the option; {names}: the aggregations that do;
  /// {aggregations}: the same after "aggregation" or "aggregations".
  std::string_view text;
  /// Whether results of these parameters can depend on the option.
  bool (*are_in_force)(const MethodParameters& in_force, std::string_view option);
};

/// `readers.text` of an option with the names filled in.
std::string names_of(const ParameterReaders& readers, std::string_view option);

/// Whether the cost or the aggregation reads an option.
bool reads(const MethodParameters& parameters, std::string_view option);

namespace readers {

inline bool reads_with_levels(const MethodParameters& p, std::string_view option) {
  return reads(p, option) && p.levels > 1;
}

inline constexpr ParameterReaders kAll = {
    "every method", [](const MethodParameters&, std::string_view) { return true; }};

// Costs.
inline constexpr ParameterReaders kCosts = {"the {costs}", reads};
inline constexpr ParameterReaders kGradient = {"the {costs} (method gradient)", reads};
inline constexpr ParameterReaders kGradientNorm = {
    "the {costs} (method gradient) with gradient-components xy",
    [](const MethodParameters& p, std::string_view option) {
      return reads(p, option) && p.gradient_components == GradientComponents::kXy;
    }};
inline constexpr ParameterReaders kSigmaMeasurement = {
    "the {costs}, the aggregation bayes, and local-stopping with certainty entropy",
    [](const MethodParameters& p, std::string_view) { return uses_sigma_measurement(p); }};
inline constexpr ParameterReaders kEpsilonMeasurement = {"the {costs}, and the {aggregations}",
                                                         reads};

// Aggregations.
inline constexpr ParameterReaders kBox = {
    "the {aggregations} (method ssd), which alone has windows", reads};
inline constexpr ParameterReaders kGaussians = {"the {aggregations} (method gradient)", reads};
inline constexpr ParameterReaders kNamed = {"{names}", reads};
inline constexpr ParameterReaders kNamedWithLevels = {"{names} with levels above 1",
                                                      reads_with_levels};
inline constexpr ParameterReaders kBayes = {"the {aggregations} (method bayes, the presets)",
                                            reads};
inline constexpr ParameterReaders kBayesWithLevels = {
    "the {aggregations} (method bayes, the presets) with levels above 1", reads_with_levels};
inline constexpr ParameterReaders kSigmaPrior = {
    "the {aggregations} (method bayes, the presets) with prior contaminated-gaussian or quadratic",
    [](const MethodParameters& p, std::string_view option) {
      return reads(p, option) && p.prior != Prior::kImpulse;
    }};
inline constexpr ParameterReaders kPriorGrowth = {
    "the {aggregations} (method bayes, the presets) with levels above 1 and prior "
    "contaminated-gaussian or quadratic",
    [](const MethodParameters& p, std::string_view option) {
      return reads_with_levels(p, option) && p.prior != Prior::kImpulse;
    }};
inline constexpr ParameterReaders kEpsilonPrior = {
    "the {aggregations} (method bayes, the presets) with prior contaminated-gaussian or impulse",
    [](const MethodParameters& p, std::string_view option) {
      return reads(p, option) && p.prior != Prior::kQuadratic;
    }};
/// The default counts as read where only it is possible.
inline constexpr ParameterReaders kSearchSize = {
    "the aggregation bayes with levels above 1, prior-smoothing maximum and cost census-rays with "
    "one threshold (the preset realtime)",
    [](const MethodParameters& p, std::string_view) {
      return p.search_size == SearchSize::kFull || can_reduce_search(p);
    }};
/// A candidate_blocks of 0 counts as read where only 0 is possible.
inline constexpr ParameterReaders kCandidateBlocks = {
    kBayesWithLevels.text, [](const MethodParameters& p, std::string_view) {
      return p.candidate_blocks == 0 || can_prune(p);
    }};
inline constexpr ParameterReaders kPrunedLevels = {
    "the {aggregations} with levels above 1 and candidate-blocks above 0 (the presets)",
    [](const MethodParameters& p, std::string_view) {
      return p.candidate_blocks > 0 && can_prune(p);
    }};
/// The default counts as read where only it is possible.
inline constexpr ParameterReaders kWindowLevels = {
    "the aggregation bayes with levels above 1, prior-smoothing maximum and cost census-rays of "
    "luma (the presets)",
    [](const MethodParameters& p, std::string_view) {
      return p.window_levels == 0 || can_search_windows(p);
    }};
inline constexpr ParameterReaders kEdges = {
    "{names} with edge-weight below 1 (the presets)",
    [](const MethodParameters& p, std::string_view) { return uses_edge_weights(p); }};

// Selection.
inline constexpr ParameterReaders kScanline = {"selection scanline",
                                               [](const MethodParameters& p, std::string_view) {
                                                 return p.selection == Selection::kScanline;
                                               }};
inline constexpr ParameterReaders kSymmetric = {"selection symmetric",
                                                [](const MethodParameters& p, std::string_view) {
                                                  return p.selection == Selection::kSymmetric;
                                                }};

}  // namespace readers
}  // namespace vantage
