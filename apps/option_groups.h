#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/match_settings.h"
#include "apps/settings.h"
#include "engine/execution.h"
#include "engine/synthesis/synthesis_options.h"

namespace vantage::apps {

/// What every working command has besides its own options.
struct CommonOptions {
  ExecutionOptions execution;
  std::string isa = "best";
  std::string report;  ///< file, empty = none
  bool quiet = false;
};

// Each binds the fields of one option struct to its settings: the only list of them.
void add_common_settings(Settings& settings, CommonOptions& options);
void add_synthesis_settings(Settings& settings, SynthesisOptions& options);

/// XS of a view given as a number or as "XS,YS". Throws UsageError unless YS is 0: views off the
/// baseline are not available.
double to_view_x(const SettingValue& value);
/// --view, repeatable.
void add_view_setting(Settings& settings, std::vector<double>& views_x);
/// --seed, a whole number of at least 0.
void add_seed_setting(Settings& settings, std::uint64_t& seed);

}  // namespace vantage::apps
