#pragma once

#include "apps/reports/run_report.h"
#include "apps/run/run_session.h"
#include "apps/run/run_settings.h"

namespace vantage::apps {

/// Whether the run writes standard output ("-").
bool writes_stream(const RunJob& job);

/// Throws UsageError for outputs that a stream cannot hold; `job` is otherwise complete.
void check_stream(const RunJob& job);

/// Writes the only output of the run to standard output, as its frames are made. Returns the exit
/// code.
int run_to_stream(const RunJob& job, const RunSession& session, Execution& execution,
                  RunReport& report);

}  // namespace vantage::apps
