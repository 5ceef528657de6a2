#include "engine/matching/match_presets.h"

namespace vantage {

PresetSettings preset_settings(MatchPreset preset) {
  PresetSettings settings;
  switch (preset) {
    case MatchPreset::kFast:
      settings.method = MatchMethod::kSsd;
      settings.parameters.cost = MatchCost::kBirchfieldTomasi;
      settings.parameters.window_px = 7;
      settings.refinement.cross_check_px = 1;
      settings.refinement.speckle_size_px = 100;
      break;
    case MatchPreset::kBalanced:
      settings.method = MatchMethod::kBayes;
      settings.parameters.sigma_prior = 0.4;
      settings.parameters.sigma_measurement = 5;
      settings.parameters.iterations = 10;
      settings.refinement.cross_check_px = 1;
      settings.refinement.speckle_size_px = 50;
      break;
    case MatchPreset::kQuality:
      settings.method = MatchMethod::kBayes;
      settings.parameters.iterations = 50;
      settings.parameters.colour = ColourUse::kChannels;
      settings.refinement.cross_check_px = 1;
      settings.refinement.speckle_size_px = 100;
      break;
  }
  return settings;
}

}  // namespace vantage
