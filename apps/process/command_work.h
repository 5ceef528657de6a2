#pragma once

#include <string>

#include "apps/reports/run_report.h"
#include "apps/settings/common_options.h"
#include "engine/execution.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// What a command works with after its options have been checked: its report, and its threads.
/// Starts the trace and forces the instruction set. Throws UsageError for an unknown one. The
/// options must outlive it.
struct CommandWork {
  CommandWork(const Settings& settings, const CommonOptions& common_options)
      : CommandWork(settings, common_options, settings.values()) {}
  /// `reported`: the settings in the report.
  CommandWork(const Settings& settings, const CommonOptions& common_options, SettingValue reported);

  /// Ends a command: writes --report and, unless --quiet, prints `message` after the command's name
  /// and the summary. Returns kExitDone.
  int finish(SettingValue results, const std::string& message);

  const CommonOptions& common;
  RunReport report;
  Execution execution;
};

}  // namespace vantage::apps
