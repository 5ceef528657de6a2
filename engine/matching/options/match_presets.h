#pragma once

#include "engine/matching/options/match_options.h"

namespace vantage {

/// Settings of a preset: a method and the differences from its defaults.
struct PresetSettings {
  MatchMethod method = MatchMethod::kSsd;
  MethodOverrides parameters;
  RefinementOverrides refinement;
};

/// kind: of the images that are matched.
PresetSettings preset_settings(MatchPreset preset, NoiseKind kind = NoiseKind::kNone);

}  // namespace vantage
