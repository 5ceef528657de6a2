#pragma once

#include "engine/matching/options/match_options.h"
#include "engine/options/settings.h"

namespace vantage {

/// An option for each field of MethodParameters, in groups.
void add_method_parameters(Settings& settings, MethodOverrides& parameters);
/// add_method_parameters() without `iterations`. For commands that compare methods: they have their
/// own option of that name.
void add_shared_method_parameters(Settings& settings, MethodOverrides& parameters);
/// An option for each field of RefinementOptions, in the current group.
void add_refinement_options(Settings& settings, RefinementOverrides& refinement);

}  // namespace vantage
