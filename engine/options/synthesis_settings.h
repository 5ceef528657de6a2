#pragma once

#include "engine/options/settings.h"
#include "engine/synthesis/synthesis_options.h"

namespace vantage {

void add_synthesis_settings(Settings& settings, SynthesisOptions& options);
// Parts of add_synthesis_settings(), in the current group.
void add_holes_setting(Settings& settings, HoleFilling& holes);
void add_soft_edges_setting(Settings& settings, bool& soft_edges);
/// Settings for combining two warped images.
void add_combining_settings(Settings& settings, SynthesisOptions& options);
/// Refuses --gamma if it has no effect.
void check_combining(const Settings& settings, const SynthesisOptions& options);
/// The settings of add_combining_settings() without --gamma.
void add_surface_settings(Settings& settings, SynthesisOptions& options);

}  // namespace vantage
