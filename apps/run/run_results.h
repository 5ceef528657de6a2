#pragma once

#include <string>

#include "apps/reports/run_report.h"
#include "apps/run/run_session.h"
#include "apps/run/run_settings.h"
#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/sequence_runner.h"

namespace vantage::apps {

/// The results of a run, for --report. `delivered`: all frames in the folder. `sound_problem`: what
/// join_segments() returned.
void fill_report(const RunJob& job, const RunSession& session, const SequenceReport& sequence,
                 const DeliveredFrames& delivered, const std::string& sound_problem,
                 RunReport& report);

/// Processor seconds of a frame by step; there is a frame.
SettingValue processor_values(const SequenceReport& sequence);

/// What matching remarked, each kind and subject once: of the first frame that has it.
std::vector<Remark> remarks_of(const RunJob& job, const SequenceReport& sequence);

/// Prints a line to stderr if videos lack the sound they should have.
void print_sound_problem(const std::string& command, const std::string& problem);

/// What a live run dropped, and its latencies, for --report; as a line on stderr, if it was one.
SettingValue live_values(const LiveReport& live);
void print_live(const SequenceReport& sequence);

/// Prints the results to stderr in a few lines. `wall_seconds`: since the start of the command.
void print_summary(const RunJob& job, const RunSession& session, const SequenceReport& sequence,
                   double wall_seconds);

}  // namespace vantage::apps
