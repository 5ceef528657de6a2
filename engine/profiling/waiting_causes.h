#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/sequence/steps/run_step.h"
#include "scheduler/trace.h"

namespace vantage {

/// Activity of a thread from begin_ns to end_ns: its innermost span that is work or waiting.
struct ThreadPiece {
  std::string_view name;  ///< of the span
  bool is_wait = false;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  int frame = -1;
};

/// The pieces of a thread whose waits have been added (scheduler::add_waits) and whose spans are
/// therefore sorted from outside; in order, disjoint, none empty. Time in joins alone is no piece.
std::vector<ThreadPiece> thread_pieces(const scheduler::ThreadTrace& thread);

/// That of a step of a frame or command; kComputing for other spans.
WorkKind work_kind(std::string_view span_name);

/// Seconds that threads of the pool waited, by cause.
struct WaitingCauses {
  double reading_s = 0;
  double computing_s = 0;
  double writing_s = 0;
  double nothing_s = 0;

  [[nodiscard]] double sum_s() const { return reading_s + computing_s + writing_s + nothing_s; }
};

/// Attributes waiting to the work going on at the same time: the waiting time of the pool's threads
/// is divided equally among the working threads of the pool, by their kind of work. If none of the
/// pool works, threads outside of it are used; if those do not work either, the cause is nothing.
/// Waits for the disk ("disk") count as writing. The total is the waiting time of the trace, whose
/// waits have been added. Thread rule: pure.
WaitingCauses waiting_causes(const scheduler::TraceData& trace);

}  // namespace vantage
