#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "apps/process/progress.h"
#include "apps/reports/profiled_command.h"
#include "engine/error.h"
#include "engine/profiling/run_measurement.h"

namespace vantage::apps {

/// A number of threads, and what the counted runs on it told.
struct Contestant {
  int threads = 1;
  bool keeps_timeline = false;  ///< of the run with the median wall time
  std::vector<RunMeasurement> runs = {};
  std::string version = {};
  std::string isa = {};
  std::vector<TimelineRow> timeline = {};
  double timeline_s = 0;
};

struct RoundOptions {
  int rounds = 5;  ///< that count; another one goes before
  std::optional<double> budget_s;
  ProgressStyle progress = ProgressStyle::kAuto;
};

/// A run of the profiled command that did not end well.
class RunFailure : public Error {
 public:
  RunFailure(const std::string& message, int exit_code) : Error(message), exit_code_(exit_code) {}
  [[nodiscard]] int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

/// Runs `command` on every number of threads in turn, a warm-up round and then the rounds that
/// count, so that a machine that slows down does so for all. Rounds that the budget has no time for
/// are left out, but for the first. Returns false when `stop` was raised. Throws RunFailure with
/// the line that the command printed, if one of its runs fails.
bool run_rounds(ProfiledCommand& command, const RoundOptions& options,
                std::vector<Contestant>& contestants, const std::atomic<bool>& stop);

}  // namespace vantage::apps
