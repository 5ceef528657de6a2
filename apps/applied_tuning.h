#pragma once

#include <filesystem>
#include <string>

#include "apps/setting_value.h"
#include "apps/settings.h"
#include "engine/image/photograph.h"
#include "engine/tuning/tuning_file.h"

namespace vantage::apps {

/// Whether and where a command looks for what `tune` has found.
struct TuningSource {
  bool ignored = false;
  std::string file;  ///< empty: default_tuning_path()
};

/// --tuning and --no-tuning, in the group of the execution settings.
void add_tuning_settings(Settings& settings, TuningSource& source);

/// The file that `source` names, or the one to look for without a name; empty: none.
std::filesystem::path file_of(const TuningSource& source);

/// What a command uses of a tuning file, and what it says about that.
struct AppliedTuning {
  TunedSettings settings;  ///< without those that the user gave
  /// For the report: key, file and settings of the entry, or why there is none.
  SettingValue report;
  /// For people: "tuned: strip-width 214"; empty where nothing is used.
  std::string summary;
};

/// What a command is going to do.
struct TuningSituation {
  TunedUse use = TunedUse::kMatch;
  const MatchOptions& match;          ///< disparities known
  const ExecutionOptions& execution;  ///< as the user gave it: goes first
  bool in_flight_given = false;       ///< the same of the frames in flight
  const Photograph& left;             ///< the (first) pair
  const Photograph& right;
};

/// Looks for the entry that fits. Never fails: what is wrong with a file is told as a warning of
/// `command` on stderr, unless `quiet`.
AppliedTuning apply_tuning(const TuningSource& source, const TuningSituation& situation,
                           const std::string& command, bool quiet);

/// For situations that no tuning is made for.
AppliedTuning no_tuning(const std::string& reason);

}  // namespace vantage::apps
