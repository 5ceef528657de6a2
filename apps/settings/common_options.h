#pragma once

#include <cstdint>
#include <string>

#include "engine/execution.h"
#include "engine/options/execution_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {

class FileChecks;

/// The options that all commands share.
struct CommonOptions {
  ExecutionOptions execution;
  std::string isa = "best";
  std::string report;  ///< file, empty = none
  std::string trace;   ///< file, empty = none
  bool quiet = false;
};

void add_common_settings(Settings& settings, CommonOptions& options,
                         Work work = Work::kWithMatching);
/// The files of --report and --trace.
void check_common_files(const CommonOptions& options, FileChecks& files);
/// --overwrite of commands that make files of their own names in a folder, which else have to be
/// absent: FileChecks::require_nothing_made_unless().
void add_overwrite_setting(Settings& settings, bool& overwrite);
/// A whole number of at least 0. Throws UsageError.
std::uint64_t to_seed(const SettingValue& value);
/// --seed.
void add_seed_setting(Settings& settings, std::uint64_t& seed);

}  // namespace vantage::apps
