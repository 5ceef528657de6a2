#pragma once

#include <string>

#include "apps/setting_value.h"
#include "scheduler/trace.h"
#include "scheduler/trace_summary.h"

namespace vantage::apps {

/// Writes `trace`, which has its waits, as Chrome trace events in JSON, which Perfetto
/// (ui.perfetto.dev) and chrome://tracing open: a track per thread, a slice per span with its
/// frame, strip and stages, categories "work", "join" and "wait". Whole or not at all. Throws Error
/// when it cannot be written.
void write_trace(const std::string& path, const scheduler::TraceData& trace,
                 const std::string& command);

/// For the report: seconds of work and waiting by thread, name, stage and frame.
SettingValue trace_report(const scheduler::TraceSummary& summary);

}  // namespace vantage::apps
