#pragma once

#include "engine/matching/options/match_options.h"

namespace vantage {

/// What a preset stands for: a method and what differs from its defaults.
struct PresetSettings {
  MatchMethod method = MatchMethod::kSsd;
  MethodOverrides parameters;
  RefinementOverrides refinement;
};

PresetSettings preset_settings(MatchPreset preset);

}  // namespace vantage
