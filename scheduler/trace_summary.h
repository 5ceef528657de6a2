#pragma once

#include <map>
#include <string>
#include <vector>

#include "scheduler/trace.h"

namespace vantage::scheduler {

/// Fills the gaps of a trace with spans. On threads of the pool it adds "idle" before, between and
/// after the outermost spans, and "wait for tasks" between the inner spans of a join. After that,
/// every moment of such a thread from 0 to wall_ns lies in a span of kind kWork or kWait that no
/// other span of these kinds within it covers, so work and waits add up to the wall time. Threads
/// outside the pool are not changed.
void add_waits(TraceData& trace);

/// Times in seconds, summed over threads.
struct TraceSummary {
  struct Thread {
    std::string name;
    bool is_in_pool = false;
    double work_s = 0;
    double wait_s = 0;
  };
  struct Named {
    double self_s = 0;       ///< without the spans within
    double processor_s = 0;  ///< of these
    int count = 0;
  };

  /// Work of the stages of one name, summed over passes, strips, threads and frames.
  struct Stage {
    double seconds = 0;
    double columns = 0;      ///< made; see StageShare
    double own_columns = 0;  ///< without halo and repetition
    ColumnWork work;         ///< of all columns made
  };

  double wall_s = 0;
  std::vector<Thread> threads;
  std::map<std::string, Named> work;    ///< by name of span
  std::map<std::string, Named> waits;   ///< by name of span
  std::map<std::string, Stage> stages;  ///< by stage of chains
  std::map<int, double> frame_work_s;   ///< by frame; −1: about none

  /// Share of the pool's time that is work, 0..1.
  [[nodiscard]] double work_share() const;
};

/// `trace` with its waits added.
[[nodiscard]] TraceSummary summarise(const TraceData& trace);

}  // namespace vantage::scheduler
