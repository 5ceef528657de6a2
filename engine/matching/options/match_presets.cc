#include "engine/matching/options/match_presets.h"

namespace vantage {
namespace {

/// Bayesian diffusion from coarse to fine (perf/log/2026-11-23-coarse-to-fine.md): census codes,
/// weights from intensity edges, candidates around the results of coarser levels.
MethodOverrides coarse_to_fine() {
  MethodOverrides parameters;
  parameters.cost = MatchCost::kRayCensus;
  parameters.sigma_measurement = 3;  // of 24 neighbours
  parameters.epsilon_measurement = 0.2;
  parameters.levels = 7;
  parameters.level_weight = 0.6;
  parameters.slant_penalty = 0.5;
  parameters.epsilon_prior = 5e-6;
  parameters.prior_growth = 1.2;
  parameters.prior_smoothing = PriorSmoothing::kMaximum;
  parameters.edge_weight = 0.2;
  parameters.candidate_blocks = 3;
  parameters.window_levels = 1;
  return parameters;
}

/// What a codec rounded is alike in pixels beside each other: their costs agree by chance, and
/// small parts differ from what is around them. Chosen in perf/log/2026-11-27-noise.md and
/// 2026-11-28-search.md.
void set_for_noise(MatchPreset preset, NoiseKind kind, MethodOverrides& parameters) {
  const bool is_coded = kind == NoiseKind::kCodec;
  if (is_coded) {
    parameters.level_weight = 0.4;
    parameters.sigma_measurement = 2.5;
    parameters.epsilon_prior = 1e-4;
    parameters.slant_penalty = 1;
  }
  if (preset == MatchPreset::kRealtime) {
    parameters.mu = is_coded ? 0.3 : 0.33;
    parameters.iterations = is_coded ? 3 : 4;
    parameters.final_iterations = is_coded ? 3 : 4;
  } else if (preset == MatchPreset::kQuality && is_coded) {
    parameters.iterations = 5;
  }
}

}  // namespace

PresetSettings preset_settings(MatchPreset preset, NoiseKind kind) {
  PresetSettings settings;
  settings.method = MatchMethod::kBayes;
  settings.parameters = coarse_to_fine();
  settings.refinement.cross_check_px = 1;
  settings.refinement.speckle_size_px = 100;
  settings.refinement.surface_fit_px = 10;
  switch (preset) {
    case MatchPreset::kRealtime:
      settings.parameters.search_size = SearchSize::kAuto;
      settings.parameters.mu = 0.25;
      settings.parameters.iterations = 2;
      settings.parameters.final_iterations = 3;
      settings.parameters.pruned_levels = 4;
      settings.refinement.cross_check_px = 1.5;
      settings.refinement.speckle_size_px = 90;
      settings.refinement.surface_fit_px = 14;
      settings.refinement.fill = Fill::kMedian;
      break;
    case MatchPreset::kBalanced:
      settings.parameters.census_thresholds = 3;
      settings.parameters.mu = 0.28;
      settings.parameters.iterations = 3;
      settings.parameters.final_iterations = 1;
      settings.refinement.surface_fit_step_px = 2;
      settings.refinement.fill = Fill::kSurfaces;
      break;
    case MatchPreset::kQuality:
      settings.parameters.census_thresholds = 3;
      settings.parameters.mu = 0.33;
      settings.parameters.iterations = 10;
      settings.parameters.final_iterations = 3;
      settings.refinement.fill = Fill::kSurfaces;
      break;
  }
  if (kind != NoiseKind::kNone) {
    set_for_noise(preset, kind, settings.parameters);
  }
  return settings;
}

}  // namespace vantage
