#include "scheduler/trace.h"

#include <chrono>
#include <ctime>
#include <utility>

namespace vantage::scheduler {

struct Trace::ThreadLog {
  Trace* trace = nullptr;
  Span* innermost = nullptr;
  ThreadTrace data;
};

namespace {

/// Traces are told apart by their serial number: a later one may have the address of an earlier.
struct ThreadState {
  std::uint64_t serial = 0;
  void* log = nullptr;
};
thread_local ThreadState g_thread_state;
std::atomic<std::uint64_t> g_last_serial{0};

}  // namespace

std::atomic<Trace*> Trace::active_{nullptr};

std::int64_t trace_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

std::int64_t thread_time_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

Trace::Trace(std::int64_t max_spans)
    : start_ns_(trace_clock_ns()), serial_(++g_last_serial), spans_left_(max_spans) {
  active_.store(this, std::memory_order_release);
  log_of_this_thread()->data.name = "main";
}

Trace::~Trace() {
  Trace* self = this;
  active_.compare_exchange_strong(self, nullptr);
}

TraceData Trace::finish() {
  active_.store(nullptr, std::memory_order_release);
  TraceData data;
  data.wall_ns = now_ns();
  data.dropped_spans = dropped_spans_.load();
  const std::lock_guard lock(mutex_);
  int workers = 0;
  for (const std::unique_ptr<ThreadLog>& log : logs_) {
    if (log->data.name.empty()) {
      log->data.name = "worker " + std::to_string(++workers);
    }
    data.threads.push_back(std::move(log->data));
  }
  return data;
}

std::int64_t Trace::now_ns() const { return trace_clock_ns() - start_ns_; }

Trace::ThreadLog* Trace::log_of_this_thread() {
  Trace* trace = active_.load(std::memory_order_acquire);
  if (trace == nullptr) {
    return nullptr;
  }
  if (g_thread_state.serial != trace->serial_) {
    auto log = std::make_unique<ThreadLog>();
    log->trace = trace;
    g_thread_state = {trace->serial_, log.get()};
    const std::lock_guard lock(trace->mutex_);
    trace->logs_.push_back(std::move(log));
  }
  return static_cast<ThreadLog*>(g_thread_state.log);
}

void Span::begin(std::string_view name, SpanKind kind, const SpanPlace& place) {
  Trace::ThreadLog* log = Trace::log_of_this_thread();
  if (log == nullptr) {
    return;
  }
  // Counted when it begins, so that a span whose inner ones are recorded is recorded, too.
  if (log->trace->spans_left_.fetch_sub(1, std::memory_order_relaxed) <= 0) {
    log->trace->dropped_spans_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  log_ = log;
  outer_ = std::exchange(log->innermost, this);
  record_.name = name;
  record_.kind = kind;
  record_.place = place;
  if (place.frame < 0 && outer_ != nullptr) {
    record_.place.frame = outer_->record_.place.frame;
  }
  record_.processor_ns = -thread_time_ns();
  record_.begin_ns = log->trace->now_ns();
}

void Span::end() {
  record_.end_ns = log_->trace->now_ns();
  record_.processor_ns += thread_time_ns();
  if (outer_ != nullptr) {
    outer_->inner_processor_ns_ += record_.processor_ns;
  }
  record_.processor_ns -= inner_processor_ns_;
  log_->innermost = outer_;
  log_->data.spans.push_back(record_);
}

void Span::add_stage(const StageShare& share) {
  std::vector<StageShare>& stages = log_->data.stages;
  if (record_.stage_count == 0) {
    record_.first_stage = stages.size();
  }
  stages.push_back(share);
  ++record_.stage_count;
}

Span* Span::innermost() {
  const Trace::ThreadLog* log = Trace::log_of_this_thread();
  return log == nullptr ? nullptr : log->innermost;
}

void Span::set_strip(int pass, int strip, int first_row) {
  record_.place.pass = pass;
  record_.place.strip = strip;
  record_.place.first_row = first_row;
}

void Span::note_pool_thread() {
  if (Trace::ThreadLog* log = Trace::log_of_this_thread()) {
    log->data.is_in_pool = true;
  }
}

void name_traced_thread(std::string_view name) {
  if (Trace::ThreadLog* log = Trace::log_of_this_thread()) {
    log->data.name = name;
  }
}

}  // namespace vantage::scheduler
