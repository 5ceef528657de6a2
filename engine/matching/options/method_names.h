#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/matching/options/method_rules.h"

namespace vantage {

/// Names of the values of an enumeration, as used in options and messages, in the order of help
/// texts.
template <typename Enum>
using EnumNames = std::vector<std::pair<std::string_view, Enum>>;

const EnumNames<MatchMethod>& method_names();
const EnumNames<MatchPreset>& preset_names();
const EnumNames<MatchCost>& cost_names();
const EnumNames<Aggregation>& aggregation_names();
const EnumNames<Selection>& selection_names();
const EnumNames<Prior>& prior_names();

std::string_view name_of(MatchMethod method);
std::string_view name_of(MatchPreset preset);
std::string_view name_of(MatchCost cost);
std::string_view name_of(Aggregation aggregation);
std::string_view name_of(Selection selection);
std::string_view name_of(Prior prior);

/// Short description of a method: "cost census-rays, aggregation bayes, 7 levels".
std::string summary_of(const MethodParameters& parameters);

}  // namespace vantage
