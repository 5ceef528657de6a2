#pragma once

#include "engine/matching/options/match_options.h"

namespace vantage {

/// Settings of a preset: a method and the differences from its defaults.
struct PresetSettings {
  MatchMethod method = MatchMethod::kSsd;
  MethodOverrides parameters;
  RefinementOverrides refinement;
};

PresetSettings preset_settings(MatchPreset preset);

}  // namespace vantage
