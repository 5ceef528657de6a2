#pragma once

#include <string>

#include "apps/reports/run_report.h"
#include "apps/run/run_session.h"
#include "apps/run/run_settings.h"

namespace vantage::apps {

/// What a run would take on this machine, as it is used now: its first frames are run, for some
/// seconds, with all steps, files and videos, in a temporary folder. Puts the forecast into
/// `report` and returns it as a line of text. Empty, without running anything, where the input is a
/// stream or shots are looked for first; also where none of these frames can be run.
std::string forecast_run(const RunJob& job, RunSession& session, Execution& execution,
                         RunReport& report);

}  // namespace vantage::apps
