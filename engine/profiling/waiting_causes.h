#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "scheduler/trace.h"

namespace vantage {

/// What a thread does from begin_ns to end_ns: the innermost of its spans that are work or waiting.
struct ThreadPiece {
  std::string_view name;  ///< of the span
  bool is_wait = false;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  int frame = -1;
};

/// The pieces of a thread whose waits have been added (scheduler::add_waits) and whose spans are
/// therefore sorted from outside; in order, apart, none empty. Time in joins alone is no piece.
std::vector<ThreadPiece> thread_pieces(const scheduler::ThreadTrace& thread);

/// Kinds of work, by the names of spans.
enum class WorkKind {
  kReading,    ///< reads or decodes images
  kComputing,  ///< anything else
  kWriting     ///< encodes or writes results
};

WorkKind work_kind(std::string_view span_name);

/// Seconds that threads of the pool waited, by what they waited for.
struct WaitingCauses {
  double reading_s = 0;
  double computing_s = 0;
  double writing_s = 0;
  double nothing_s = 0;

  [[nodiscard]] double sum_s() const { return reading_s + computing_s + writing_s + nothing_s; }
};

/// Whoever waits, waits for those who work at that moment: the waiting of the pool's threads is
/// divided equally among the threads of the pool that work meanwhile, by the kind of what they do.
/// Where none of the pool works, threads outside of it count; where these do not either, it is
/// waiting for nothing. Waits for the disk ("disk") are for writing. All of it is the waiting of
/// the trace, whose waits have been added. Thread rule: pure.
WaitingCauses waiting_causes(const scheduler::TraceData& trace);

}  // namespace vantage
