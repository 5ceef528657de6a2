#pragma once

#include "apps/run_report.h"
#include "apps/run_session.h"
#include "apps/run_settings.h"
#include "engine/sequence/delivered_frames.h"
#include "engine/sequence/sequence_runner.h"

namespace vantage::apps {

/// What a run has come to, for --report. `delivered`: all of the folder.
void fill_report(const RunJob& job, const RunSession& session, const SequenceReport& sequence,
                 const DeliveredFrames& delivered, RunReport& report);

/// The same in a few lines on stderr. `wall_seconds`: from the start of the command on.
void print_summary(const RunJob& job, const RunSession& session, const SequenceReport& sequence,
                   double wall_seconds);

/// How much results flicker, as a report shows it; null where it was not measured.
SettingValue flicker_values(const FlickerSums& sums);

}  // namespace vantage::apps
