#include "engine/profiling/waiting_causes.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

using scheduler::SpanKind;
using scheduler::SpanRecord;

// Beside the steps of a frame: those of commands, and the parts of the pipeline of frames.
constexpr std::array<std::string_view, 3> kReadingSpans = {"open", "read frame", "prepare frame"};
constexpr std::array<std::string_view, 3> kWritingSpans = {"encode frame", "write frame", "join"};
constexpr std::string_view kDiskWait = "disk";

/// A change in the number of active threads of a kind.
struct Change {
  enum Counter : std::uint8_t {
    kPoolReading,  // in the order of WorkKind
    kPoolComputing,
    kPoolWriting,
    kOthersReading,
    kOthersComputing,
    kOthersWriting,
    kDiskWaiting,
    kWaiting,
    kCounters
  };
  std::int64_t time_ns;
  Counter counter;
  int step;
};

Change::Counter counter_of(const ThreadPiece& piece, bool is_in_pool) {
  if (piece.is_wait) {
    return piece.name == kDiskWait ? Change::kDiskWaiting : Change::kWaiting;
  }
  const auto kind = static_cast<int>(work_kind(piece.name));
  return static_cast<Change::Counter>((is_in_pool ? Change::kPoolReading : Change::kOthersReading) +
                                      kind);
}

std::vector<Change> changes_in(const scheduler::TraceData& trace) {
  std::vector<Change> changes;
  for (const scheduler::ThreadTrace& thread : trace.threads) {
    for (const ThreadPiece& piece : thread_pieces(thread)) {
      if (piece.is_wait && !thread.is_in_pool) {
        continue;
      }
      const Change::Counter counter = counter_of(piece, thread.is_in_pool);
      changes.push_back({piece.begin_ns, counter, 1});
      changes.push_back({piece.end_ns, counter, -1});
    }
  }
  std::ranges::sort(changes, {}, &Change::time_ns);
  return changes;
}

using Counts = std::array<int, Change::kCounters>;

/// Divides `waiting_s` by the counts of the three kinds of work from `first` on; false if no thread
/// works.
bool divide(double waiting_s, const Counts& counts, std::size_t first, WaitingCauses& causes) {
  const int all = counts[first] + counts[first + 1] + counts[first + 2];
  if (all == 0) {
    return false;
  }
  causes.reading_s += waiting_s * counts[first] / all;
  causes.computing_s += waiting_s * counts[first + 1] / all;
  causes.writing_s += waiting_s * counts[first + 2] / all;
  return true;
}

}  // namespace

WorkKind work_kind(std::string_view span_name) {
  const auto step = std::ranges::find(frame_steps(), span_name, &StepEntry::name);
  if (step != frame_steps().end()) {
    return step->kind;
  }
  if (std::ranges::find(kReadingSpans, span_name) != kReadingSpans.end()) {
    return WorkKind::kReading;
  }
  if (std::ranges::find(kWritingSpans, span_name) != kWritingSpans.end()) {
    return WorkKind::kWriting;
  }
  return WorkKind::kComputing;
}

std::vector<ThreadPiece> thread_pieces(const scheduler::ThreadTrace& thread) {
  std::vector<ThreadPiece> pieces;
  std::vector<const SpanRecord*> open;
  std::int64_t covered_to_ns = 0;
  // Attributes the time until `end_ns` to the innermost open span.
  const auto cover = [&](std::int64_t end_ns) {
    if (!open.empty() && open.back()->kind != SpanKind::kJoin && end_ns > covered_to_ns) {
      const SpanRecord& span = *open.back();
      pieces.push_back(
          {span.name, span.kind == SpanKind::kWait, covered_to_ns, end_ns, span.place.frame});
    }
    covered_to_ns = std::max(covered_to_ns, end_ns);
  };
  const auto close_until = [&](std::int64_t time_ns) {
    while (!open.empty() && open.back()->end_ns <= time_ns) {
      cover(open.back()->end_ns);
      open.pop_back();
    }
  };
  for (const SpanRecord& span : thread.spans) {
    close_until(span.begin_ns);
    cover(span.begin_ns);
    open.push_back(&span);
  }
  while (!open.empty()) {
    cover(open.back()->end_ns);
    open.pop_back();
  }
  return pieces;
}

WaitingCauses waiting_causes(const scheduler::TraceData& trace) {
  WaitingCauses causes;
  Counts counts{};
  std::int64_t now_ns = 0;
  for (const Change& change : changes_in(trace)) {
    const double passed_s = static_cast<double>(change.time_ns - now_ns) * 1e-9;
    now_ns = change.time_ns;
    causes.writing_s += passed_s * counts[Change::kDiskWaiting];
    const double waiting_s = passed_s * counts[Change::kWaiting];
    if (!divide(waiting_s, counts, Change::kPoolReading, causes) &&
        !divide(waiting_s, counts, Change::kOthersReading, causes)) {
      causes.nothing_s += waiting_s;
    }
    counts[change.counter] += change.step;
  }
  return causes;
}

}  // namespace vantage
