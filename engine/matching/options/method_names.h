#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/matching/options/method_rules.h"
#include "engine/refinement/refinement_options.h"

namespace vantage {

/// Names of the values of an enumeration, as used in options and messages, in the order of help
/// texts.
template <typename Enum>
using EnumNames = std::vector<std::pair<std::string_view, Enum>>;

// The argument only says which enumeration.
const EnumNames<MatchMethod>& names_of(MatchMethod);
const EnumNames<MatchPreset>& names_of(MatchPreset);
const EnumNames<MatchCost>& names_of(MatchCost);
const EnumNames<ColourUse>& names_of(ColourUse);
const EnumNames<GradientNorm>& names_of(GradientNorm);
const EnumNames<GradientComponents>& names_of(GradientComponents);
const EnumNames<GradientFilter>& names_of(GradientFilter);
const EnumNames<Aggregation>& names_of(Aggregation);
const EnumNames<Border>& names_of(Border);
const EnumNames<Certainty>& names_of(Certainty);
const EnumNames<Prior>& names_of(Prior);
const EnumNames<PriorSmoothing>& names_of(PriorSmoothing);
const EnumNames<SearchSize>& names_of(SearchSize);
const EnumNames<Selection>& names_of(Selection);
const EnumNames<Subpixel>& names_of(Subpixel);
const EnumNames<Fill>& names_of(Fill);

template <typename Enum>
requires requires(Enum value) { names_of(value); }
std::string_view name_of(Enum value) {
  for (const auto& [name, named] : names_of(value)) {
    if (named == value) {
      return name;
    }
  }
  return "";
}

/// Short description of a method: "cost census-rays, aggregation bayes, 7 levels".
std::string summary_of(const MethodParameters& parameters);

}  // namespace vantage
