#include "engine/matching/match_presets.h"

namespace vantage {

PresetSettings preset_settings(MatchPreset preset) {
  PresetSettings settings;
  // Compared on ten scenes (docs/QUALITY.md): census codes beat all other costs on photographs,
  // whose cameras never quite agree in brightness.
  settings.method = MatchMethod::kSsd;
  settings.parameters.cost = MatchCost::kCensus;
  settings.refinement.cross_check_px = 1;
  settings.refinement.speckle_size_px = 100;
  switch (preset) {
    case MatchPreset::kFast:
      settings.parameters.window_px = 7;
      break;
    case MatchPreset::kBalanced:
      settings.parameters.aggregation = Aggregation::kBoxCascade;
      break;
    case MatchPreset::kQuality:
      settings.method = MatchMethod::kBayes;
      settings.parameters.sigma_measurement = 16;
      settings.parameters.iterations = 30;
      // Takes half as long as the other presets take altogether (docs/VIEWS.md).
      settings.refinement.fill = Fill::kMedian;
      break;
  }
  return settings;
}

}  // namespace vantage
