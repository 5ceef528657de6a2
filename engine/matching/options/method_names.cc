#include "engine/matching/options/method_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/cost_table.h"

namespace vantage {
namespace {

template <typename Enum>
std::string_view name_among(const EnumNames<Enum>& names, Enum value) {
  return std::ranges::find(names, value, &std::pair<std::string_view, Enum>::second)->first;
}

template <typename Enum, typename Entry>
EnumNames<Enum> names_in_table(std::span<const Entry> table) {
  EnumNames<Enum> names;
  for (const Entry& entry : table) {
    names.emplace_back(entry.name, entry.key);
  }
  return names;
}

}  // namespace

const EnumNames<MatchMethod>& method_names() {
  static const EnumNames<MatchMethod> names = {{"ssd", MatchMethod::kSsd},
                                               {"gradient", MatchMethod::kGradient},
                                               {"diffusion", MatchMethod::kDiffusion},
                                               {"membrane", MatchMethod::kMembrane},
                                               {"local-stopping", MatchMethod::kLocalStopping},
                                               {"bayes", MatchMethod::kBayes}};
  return names;
}

const EnumNames<MatchPreset>& preset_names() {
  static const EnumNames<MatchPreset> names = {{"realtime", MatchPreset::kRealtime},
                                               {"fast", MatchPreset::kFast},
                                               {"balanced", MatchPreset::kBalanced},
                                               {"quality", MatchPreset::kQuality}};
  return names;
}

const EnumNames<Selection>& selection_names() {
  static const EnumNames<Selection> names = {{"winner", Selection::kWinner},
                                             {"scanline", Selection::kScanline},
                                             {"symmetric", Selection::kSymmetric}};
  return names;
}

const EnumNames<Prior>& prior_names() {
  static const EnumNames<Prior> names = {{"contaminated-gaussian", Prior::kContaminatedGaussian},
                                         {"impulse", Prior::kImpulse},
                                         {"quadratic", Prior::kQuadratic}};
  return names;
}

const EnumNames<MatchCost>& cost_names() {
  static const auto names = names_in_table<MatchCost>(cost_table());
  return names;
}

const EnumNames<Aggregation>& aggregation_names() {
  static const auto names = names_in_table<Aggregation>(aggregation_table());
  return names;
}

std::string_view name_of(MatchMethod method) { return name_among(method_names(), method); }
std::string_view name_of(MatchPreset preset) { return name_among(preset_names(), preset); }
std::string_view name_of(Selection selection) { return name_among(selection_names(), selection); }
std::string_view name_of(Prior prior) { return name_among(prior_names(), prior); }
std::string_view name_of(MatchCost cost) { return cost_of(cost).name; }
std::string_view name_of(Aggregation aggregation) { return aggregation_of(aggregation).name; }

std::string summary_of(const MethodParameters& parameters) {
  const bool has_other_prior = parameters.aggregation == Aggregation::kBayes &&
                               parameters.prior != Prior::kContaminatedGaussian;
  return fmt::format("cost {}, aggregation {}, {} level{}{}{}", name_of(parameters.cost),
                     name_of(parameters.aggregation), parameters.levels,
                     parameters.levels == 1 ? "" : "s",
                     has_other_prior ? fmt::format(", prior {}", name_of(parameters.prior)) : "",
                     parameters.selection == Selection::kWinner
                         ? ""
                         : fmt::format(", selection {}", name_of(parameters.selection)));
}

}  // namespace vantage
