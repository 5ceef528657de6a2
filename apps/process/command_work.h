#pragma once

#include "apps/reports/run_report.h"
#include "apps/settings/common_options.h"
#include "engine/execution.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// What a command works with after its options have been checked: its report, and its threads.
/// Starts the trace and forces the instruction set. Throws UsageError for an unknown one.
struct CommandWork {
  CommandWork(const Settings& settings, const CommonOptions& common)
      : CommandWork(settings, common, settings.values()) {}
  /// `reported`: the settings in the report.
  CommandWork(const Settings& settings, const CommonOptions& common, SettingValue reported);

  RunReport report;
  Execution execution;
};

}  // namespace vantage::apps
