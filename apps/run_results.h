#pragma once

#include <string>

#include "apps/run_report.h"
#include "apps/run_session.h"
#include "apps/run_settings.h"
#include "engine/sequence/delivered_frames.h"
#include "engine/sequence/sequence_runner.h"

namespace vantage::apps {

/// What a run has come to, for --report. `delivered`: all of the folder. `sound_problem`: what
/// join_segments() returned.
void fill_report(const RunJob& job, const RunSession& session, const SequenceReport& sequence,
                 const DeliveredFrames& delivered, const std::string& sound_problem,
                 RunReport& report);

/// A line on stderr where videos are without the sound they should have.
void print_sound_problem(const std::string& command, const std::string& problem);

/// The same in a few lines on stderr. `wall_seconds`: from the start of the command on.
void print_summary(const RunJob& job, const RunSession& session, const SequenceReport& sequence,
                   double wall_seconds);

/// How much results flicker, as a report shows it; null where it was not measured.
SettingValue flicker_values(const FlickerSums& sums);

}  // namespace vantage::apps
