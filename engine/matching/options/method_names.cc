#include "engine/matching/options/method_names.h"

#include <fmt/format.h>

#include <algorithm>

namespace vantage {
namespace {

template <typename Enum>
std::string_view name_among(const EnumNames<Enum>& names, Enum value) {
  return std::ranges::find(names, value, &std::pair<std::string_view, Enum>::second)->first;
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
  static const EnumNames<MatchPreset> names = {{"fast", MatchPreset::kFast},
                                               {"balanced", MatchPreset::kBalanced},
                                               {"quality", MatchPreset::kQuality}};
  return names;
}

const EnumNames<MatchCost>& cost_names() {
  static const EnumNames<MatchCost> names = {
      {"squared", MatchCost::kSquared},     {"absolute", MatchCost::kAbsolute},
      {"truncated", MatchCost::kTruncated}, {"birchfield-tomasi", MatchCost::kBirchfieldTomasi},
      {"gradient", MatchCost::kGradient},   {"contaminated", MatchCost::kContaminated},
      {"census", MatchCost::kCensus},       {"census-rays", MatchCost::kRayCensus},
      {"combined", MatchCost::kCombined}};
  return names;
}

const EnumNames<Aggregation>& aggregation_names() {
  static const EnumNames<Aggregation> names = {{"none", Aggregation::kNone},
                                               {"box", Aggregation::kBox},
                                               {"gaussian", Aggregation::kGaussian},
                                               {"box-cascade", Aggregation::kBoxCascade},
                                               {"diffusion", Aggregation::kDiffusion},
                                               {"membrane", Aggregation::kMembrane},
                                               {"local-stopping", Aggregation::kLocalStopping},
                                               {"bayes", Aggregation::kBayes}};
  return names;
}

std::string_view name_of(MatchMethod method) { return name_among(method_names(), method); }
std::string_view name_of(MatchPreset preset) { return name_among(preset_names(), preset); }
std::string_view name_of(MatchCost cost) { return name_among(cost_names(), cost); }
std::string_view name_of(Aggregation aggregation) {
  return name_among(aggregation_names(), aggregation);
}

std::string summary_of(const MethodParameters& parameters) {
  return fmt::format("cost {}, aggregation {}, {} level{}", name_of(parameters.cost),
                     name_of(parameters.aggregation), parameters.levels,
                     parameters.levels == 1 ? "" : "s");
}

}  // namespace vantage
