#include "engine/matching/options/method_names.h"

#include <fmt/format.h>

#include <span>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/cost_table.h"

namespace vantage {
namespace {

template <typename Enum, typename Entry>
EnumNames<Enum> names_in_table(std::span<const Entry> table) {
  EnumNames<Enum> names;
  for (const Entry& entry : table) {
    names.emplace_back(entry.name, entry.key);
  }
  return names;
}

}  // namespace

const EnumNames<MatchMethod>& names_of(MatchMethod /*type*/) {
  static const EnumNames<MatchMethod> names = {{"ssd", MatchMethod::kSsd},
                                               {"gradient", MatchMethod::kGradient},
                                               {"diffusion", MatchMethod::kDiffusion},
                                               {"membrane", MatchMethod::kMembrane},
                                               {"local-stopping", MatchMethod::kLocalStopping},
                                               {"bayes", MatchMethod::kBayes}};
  return names;
}

const EnumNames<MatchPreset>& names_of(MatchPreset /*type*/) {
  static const EnumNames<MatchPreset> names = {{"realtime", MatchPreset::kRealtime},
                                               {"balanced", MatchPreset::kBalanced},
                                               {"quality", MatchPreset::kQuality}};
  return names;
}

const EnumNames<ColourUse>& names_of(ColourUse /*type*/) {
  static const EnumNames<ColourUse> names = {{"luma", ColourUse::kLuma},
                                             {"channels", ColourUse::kChannels}};
  return names;
}

const EnumNames<GradientNorm>& names_of(GradientNorm /*type*/) {
  static const EnumNames<GradientNorm> names = {{"l2", GradientNorm::kL2},
                                                {"octagon", GradientNorm::kOctagon},
                                                {"l1", GradientNorm::kL1},
                                                {"max", GradientNorm::kMax}};
  return names;
}

const EnumNames<GradientComponents>& names_of(GradientComponents /*type*/) {
  static const EnumNames<GradientComponents> names = {{"xy", GradientComponents::kXy},
                                                      {"x", GradientComponents::kX}};
  return names;
}

const EnumNames<GradientFilter>& names_of(GradientFilter /*type*/) {
  static const EnumNames<GradientFilter> names = {{"central", GradientFilter::kCentral},
                                                  {"sobel", GradientFilter::kSobel},
                                                  {"simoncelli3", GradientFilter::kSimoncelli3},
                                                  {"simoncelli5", GradientFilter::kSimoncelli5},
                                                  {"forward", GradientFilter::kForward}};
  return names;
}

const EnumNames<Border>& names_of(Border /*type*/) {
  static const EnumNames<Border> names = {{"clip", Border::kClip}, {"valid", Border::kValid}};
  return names;
}

const EnumNames<Certainty>& names_of(Certainty /*type*/) {
  static const EnumNames<Certainty> names = {{"margin", Certainty::kMargin},
                                             {"entropy", Certainty::kEntropy}};
  return names;
}

const EnumNames<Prior>& names_of(Prior /*type*/) {
  static const EnumNames<Prior> names = {{"contaminated-gaussian", Prior::kContaminatedGaussian},
                                         {"impulse", Prior::kImpulse},
                                         {"quadratic", Prior::kQuadratic}};
  return names;
}

const EnumNames<PriorSmoothing>& names_of(PriorSmoothing /*type*/) {
  static const EnumNames<PriorSmoothing> names = {{"sum", PriorSmoothing::kSum},
                                                  {"maximum", PriorSmoothing::kMaximum}};
  return names;
}

const EnumNames<SearchSize>& names_of(SearchSize /*type*/) {
  static const EnumNames<SearchSize> names = {{"full", SearchSize::kFull},
                                              {"half", SearchSize::kHalf},
                                              {"quarter", SearchSize::kQuarter},
                                              {"auto", SearchSize::kAuto}};
  return names;
}

const EnumNames<Selection>& names_of(Selection /*type*/) {
  static const EnumNames<Selection> names = {{"winner", Selection::kWinner},
                                             {"scanline", Selection::kScanline},
                                             {"symmetric", Selection::kSymmetric}};
  return names;
}

const EnumNames<Subpixel>& names_of(Subpixel /*type*/) {
  static const EnumNames<Subpixel> names = {{"parabola", Subpixel::kParabola},
                                            {"none", Subpixel::kNone}};
  return names;
}

const EnumNames<Fill>& names_of(Fill /*type*/) {
  static const EnumNames<Fill> names = {
      {"constant", Fill::kConstant},    {"linear", Fill::kLinear},
      {"median", Fill::kMedian},        {"planes", Fill::kPlanes},
      {"surfaces", Fill::kSurfaces},    {"canonical", Fill::kCanonical},
      {"thin-plate", Fill::kThinPlate}, {"none", Fill::kNone}};
  return names;
}

const EnumNames<MatchCost>& names_of(MatchCost /*type*/) {
  static const auto names = names_in_table<MatchCost>(cost_table());
  return names;
}

const EnumNames<Aggregation>& names_of(Aggregation /*type*/) {
  static const auto names = names_in_table<Aggregation>(aggregation_table());
  return names;
}

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
