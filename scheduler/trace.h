#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "scheduler/row_stage.h"

namespace vantage::scheduler {

/// What a thread does during a span.
enum class SpanKind : std::uint8_t {
  kWork,  ///< computes, or reads and writes files
  kJoin,  ///< takes part in a loop of tasks; where none of them covers it, it waits for other
          ///< threads
  kWait   ///< is blocked or has nothing to do
};

/// The part of the work that a span belongs to; −1: not applicable.
struct SpanPlace {
  int frame = -1;
  int task = -1;
  int pass = -1;
  int strip = -1;
  int first_row = -1;  ///< of the band
};

/// Work of one stage of a chain within a span.
struct StageShare {
  std::string_view name;
  std::int64_t duration_ns = 0;
  int rows = 0;
  double columns = 0;  ///< made, summed over the rows
  /// Columns inside the strip and band of the span. The rest is halo, warm-up rows of running sums,
  /// and columns that a later pass makes again.
  double own_columns = 0;
  ColumnWork column_work;  ///< of each column
};

/// What a thread did from begin_ns to end_ns after the start of the trace. Spans of a thread nest:
/// two of them either do not overlap, or one lies within the other.
struct SpanRecord {
  std::string_view name;
  SpanKind kind = SpanKind::kWork;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t processor_ns = 0;  ///< of the thread, without the spans within
  SpanPlace place;
  std::size_t first_stage = 0;  ///< its stages in ThreadTrace::stages
  std::size_t stage_count = 0;
};

struct ThreadTrace {
  std::string name;               ///< "main", "worker 1", or what name_traced_thread() said
  bool is_in_pool = false;        ///< has run tasks or steps of frames
  std::vector<SpanRecord> spans;  ///< a span comes after the spans within it
  std::vector<StageShare> stages;
};

/// What a trace has recorded.
struct TraceData {
  std::int64_t wall_ns = 0;
  std::int64_t dropped_spans = 0;    ///< those beyond max_spans
  std::vector<ThreadTrace> threads;  ///< in the order of their first spans; the first is "main"
};

/// Records the spans of all threads of this process from its construction to finish(). Without an
/// active trace, a Span costs one load and a branch.
///
/// Thread rule: construct, finish and destroy it on one thread ("main"), one trace at a time,
/// while no other thread has a span open.
class Trace {
 public:
  static constexpr std::int64_t kMaxSpans = 4'000'000;  // about 300 MB

  explicit Trace(std::int64_t max_spans = kMaxSpans);
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;
  ~Trace();

  /// Ends the recording and returns it.
  [[nodiscard]] TraceData finish();

  [[nodiscard]] static bool is_active() {
    return active_.load(std::memory_order_relaxed) != nullptr;
  }

 private:
  friend class Span;
  friend void name_traced_thread(std::string_view name);
  struct ThreadLog;

  /// This thread's log in the active trace; null if there is none.
  static ThreadLog* log_of_this_thread();
  [[nodiscard]] std::int64_t now_ns() const;

  static std::atomic<Trace*> active_;

  std::int64_t start_ns_;
  std::uint64_t serial_;
  std::atomic<std::int64_t> spans_left_;
  std::atomic<std::int64_t> dropped_spans_{0};
  std::mutex mutex_;  // guards logs_
  std::deque<std::unique_ptr<ThreadLog>> logs_;
};

/// A span from construction to destruction. `name` must outlive the trace (a literal). Without a
/// frame of its own it belongs to the frame of the enclosing span.
class Span {
 public:
  explicit Span(std::string_view name, SpanKind kind = SpanKind::kWork,
                const SpanPlace& place = {}) {
    if (Trace::is_active()) {
      begin(name, kind, place);
    }
  }
  Span(const Span&) = delete;
  Span& operator=(const Span&) = delete;
  ~Span() {
    if (log_ != nullptr) {
      end();
    }
  }

  /// The innermost recorded span of this thread; null without one.
  [[nodiscard]] static Span* innermost();
  [[nodiscard]] const SpanRecord& record() const { return record_; }
  /// For the task that sweeps a strip and band in one pass of a chain. Only for recorded spans.
  void set_strip(int pass, int strip, int first_row);
  /// Adds the work of a stage. Only for recorded spans.
  void add_stage(const StageShare& share);
  /// Notes that this thread belongs to the pool.
  static void note_pool_thread();

 private:
  void begin(std::string_view name, SpanKind kind, const SpanPlace& place);
  void end();

  Trace::ThreadLog* log_ = nullptr;
  Span* outer_ = nullptr;
  std::int64_t inner_processor_ns_ = 0;  ///< of the spans within
  SpanRecord record_;
};

/// Processor time of this thread.
[[nodiscard]] std::int64_t thread_time_ns();

/// Nanoseconds on the clock of traces.
[[nodiscard]] std::int64_t trace_clock_ns();

/// Names this thread in the active trace, if there is one. For threads outside the pool.
void name_traced_thread(std::string_view name);

}  // namespace vantage::scheduler
