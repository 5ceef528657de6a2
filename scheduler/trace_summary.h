#pragma once

#include <map>
#include <string>
#include <vector>

#include "scheduler/trace.h"

namespace vantage::scheduler {

/// Writes down as spans what a trace leaves open: on threads of the pool, the time before, between
/// and behind the outermost spans ("idle"), and within joins that between their inner spans
/// ("wait for tasks"). Afterwards every moment of such a thread from 0 to wall_ns lies in a span of
/// kind kWork or kWait that no other span of these kinds within it covers. Threads outside of the
/// pool stay as they are.
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
    double self_s = 0;  ///< without the spans within
    int count = 0;
  };

  /// What the stages of one name did, summed over passes, strips, threads and frames.
  struct Stage {
    double seconds = 0;
    double columns = 0;      ///< made; see StageShare
    double own_columns = 0;  ///< of them, without halo and repetition
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
