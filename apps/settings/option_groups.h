#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/process/outputs.h"
#include "apps/settings/match_settings.h"
#include "apps/settings/settings.h"
#include "engine/execution.h"
#include "engine/synthesis/synthesis_options.h"

namespace vantage::apps {

/// The options that all commands share.
struct CommonOptions {
  ExecutionOptions execution;
  std::string isa = "best";
  std::string report;  ///< file, empty = none
  std::string trace;   ///< file, empty = none
  bool quiet = false;
};

// Each binds the fields of one option struct to its settings: the only list of them.
/// Whether a command matches pairs: only then there are strips, bands and passes.
enum class Work { kWithMatching, kWithoutMatching };
void add_common_settings(Settings& settings, CommonOptions& options,
                         Work work = Work::kWithMatching);
/// The files of --report and --trace.
void check_common_files(const CommonOptions& options, FileChecks& files);
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

/// A whole number of at least 0. Throws UsageError.
std::uint64_t to_seed(const SettingValue& value);
/// --seed.
void add_seed_setting(Settings& settings, std::uint64_t& seed);

}  // namespace vantage::apps
