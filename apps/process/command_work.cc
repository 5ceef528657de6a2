#include "apps/process/command_work.h"

#include <utility>

#include "apps/commands/commands.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "engine/simd.h"

namespace vantage::apps {
namespace {

/// The options of the execution, with the trace and the instruction set in place.
const ExecutionOptions& ready(const CommonOptions& common, RunReport& report) {
  report.start_trace(common.trace);
  force_instruction_set(common.isa);
  return common.execution;
}

}  // namespace

CommandWork::CommandWork(const Settings& settings, const CommonOptions& common_options,
                         SettingValue reported)
    : common(common_options),
      report(settings.command(), std::move(reported)),
      execution(ready(common_options, report)) {
  report.set_execution(execution);
  tell_threads(execution, common, report);
}

int CommandWork::finish(SettingValue results, const std::string& message) {
  report.set_results(std::move(results));
  report.write(common.report);
  if (!common.quiet) {
    tell("{}: {}\n", report.command(), message);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
