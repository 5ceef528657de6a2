#pragma once

#include <filesystem>
#include <string>

#include "engine/image/photograph.h"
#include "engine/options/setting_value.h"
#include "engine/options/settings.h"
#include "engine/tuning/tuning_file.h"

namespace vantage::apps {

/// The tuning file that a command reads, if any.
struct TuningSource {
  bool ignored = false;
  std::string file;  ///< empty: default_tuning_path()
};

/// --tuning and --no-tuning, in the group of the execution settings.
void add_tuning_settings(Settings& settings, TuningSource& source);

/// The path of `source`, else the default path; empty: none.
std::filesystem::path file_of(const TuningSource& source);

/// The tuned settings that a command uses, and how it reports them.
struct AppliedTuning {
  TunedSettings settings;  ///< without those that the user gave
  /// For the report: key, file and settings of the entry, or why there is none.
  SettingValue report;
  /// For people: "tuned: strip-width 214"; empty where nothing is used.
  std::string summary;
};

/// The work that a command will do.
struct TuningSituation {
  TunedUse use = TunedUse::kMatch;
  const MatchOptions& match;          ///< disparities known
  const ExecutionOptions& execution;  ///< as the user gave it; takes precedence
  bool in_flight_given = false;       ///< the same of the frames in flight
  const Photograph& left;             ///< the (first) pair
  const Photograph& right;
};

/// Finds the matching entry. Never fails: problems of the file are printed as warnings of
/// `command`, unless `quiet`.
AppliedTuning apply_tuning(const TuningSource& source, const TuningSituation& situation,
                           const std::string& command, bool quiet);

/// The result if tuning does not apply.
AppliedTuning no_tuning(const std::string& reason);

}  // namespace vantage::apps
