#pragma once

#include <set>
#include <string>

#include "engine/options/setting_value.h"
#include "engine/profiling/waiting_causes.h"
#include "scheduler/trace.h"
#include "scheduler/trace_summary.h"

namespace vantage::apps {

/// Writes `trace`, which has its waits, as Chrome trace events in JSON, which Perfetto
/// (ui.perfetto.dev) and chrome://tracing open: a track per thread, a slice per span with its
/// frame, strip and stages, categories "work", "join" and "wait". Whole or not at all. Throws Error
/// when it cannot be written.
void write_trace(const std::string& path, const scheduler::TraceData& trace,
                 const std::string& command);

/// A trace read from a file; the names of its spans are those it holds.
struct StoredTrace {
  std::set<std::string> names;
  scheduler::TraceData trace;  ///< with its waits, without stages and places but for frames
};

/// Reads what write_trace() wrote. Throws Error when it cannot be read.
StoredTrace read_trace(const std::string& path);

/// For the report: seconds of work and waiting by thread, name, stage, frame and cause.
SettingValue trace_report(const scheduler::TraceSummary& summary, const WaitingCauses& causes);

}  // namespace vantage::apps
