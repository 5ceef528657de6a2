#pragma once

#include <optional>
#include <string>

#include "apps/settings/common_options.h"
#include "engine/matching/options/match_options.h"
#include "engine/options/settings.h"
#include "engine/tuning/tuning_session.h"

namespace vantage::apps {

enum class TunedCommands { kMatch, kRun, kBoth };

/// What `tune` is asked for.
struct TuneJob {
  MatchOptions match;
  CommonOptions common;
  std::optional<TunedImages> images;
  bool grey = false;
  double budget_seconds = 60;
  TunedCommands uses = TunedCommands::kBoth;
  std::string output;
  bool dry_run = false;
  bool list = false;
};

/// Searches for the fastest plans and stores them, or lists what is stored. Returns the
/// exit code. Throws UsageError and Error.
int run_tune(const TuneJob& job, const Settings& settings);

}  // namespace vantage::apps
