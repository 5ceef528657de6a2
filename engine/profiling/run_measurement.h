#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/profiling/profile.h"
#include "engine/profiling/waiting_causes.h"

namespace vantage {

/// Measurements of one run of a profiled command. Names as in ThreadCountProfile.
struct RunMeasurement {
  struct Stage {
    double seconds = 0;
    double columns = 0;
    double own_columns = 0;
    double cells = 0;
    double operations = 0;
    double bytes = 0;
  };
  struct Part {
    double seconds = 0;
    double count = 0;
    double processor_s = 0;
  };

  double wall_s = 0;
  double compute_s = 0;
  double cells_per_s = 0;
  double frames = 1;
  double frames_per_s = 0;  ///< 0 for one pair
  double work_share = 0;
  std::vector<ThreadProfile> workers;
  /// Seconds of the command's steps from its report: "read", "check", "match left", …
  std::map<std::string, double> steps;
  std::map<std::string, Part> frame_steps;  ///< of a run: processor time by account
  std::map<std::string, Stage> stages;
  std::map<std::string, Part> parts;
  std::map<std::string, Part> waits;
  WaitingCauses waiting_for;
  std::uint64_t peak_memory_bytes = 0;
  std::vector<MemoryOwner> memory;
};

/// Index of the run with the median wall time; of an even number the faster of the two in the
/// middle. `runs`: at least one.
std::size_t median_run(std::span<const RunMeasurement> runs);

/// Medians and ranges over `runs` (at least one) on `threads` threads. A stage, part or wait
/// missing in a run counts as 0 there. Thread rule: pure.
ThreadCountProfile summarise_runs(int threads, std::span<const RunMeasurement> runs);

/// Medians of the steps' seconds; a step missing in a run counts as 0 there.
std::map<std::string, double> median_steps(std::span<const RunMeasurement> runs);

/// Maximum ÷ mean work of a thread of the pool; 1 if empty.
double imbalance_of(std::span<const ThreadProfile> workers);

}  // namespace vantage
