#include "apps/process/command_work.h"

#include <utility>

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

CommandWork::CommandWork(const Settings& settings, const CommonOptions& common,
                         SettingValue reported)
    : report(settings.command(), std::move(reported)), execution(ready(common, report)) {
  report.set_execution(execution);
}

}  // namespace vantage::apps
