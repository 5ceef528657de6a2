#include "scheduler/trace_summary.h"

#include <algorithm>
#include <cstdint>

namespace vantage::scheduler {
namespace {

/// A span comes ahead of those within it.
void sort_from_outside(std::vector<SpanRecord>& spans) {
  std::stable_sort(spans.begin(), spans.end(), [](const SpanRecord& a, const SpanRecord& b) {
    return a.begin_ns != b.begin_ns ? a.begin_ns < b.begin_ns : a.end_ns > b.end_ns;
  });
}

/// Calls leave(span, nanoseconds of it that no span within covers) for all `spans`, which are
/// sorted, and gap(outer, begin, end) for each stretch of a span between those directly within it;
/// `outer` is null for what lies in no span.
template <typename Leave, typename Gap>
void walk(const std::vector<SpanRecord>& spans, std::int64_t wall_ns, const Leave& leave,
          const Gap& gap) {
  struct Open {
    const SpanRecord* span;
    std::int64_t covered_to_ns;
    std::int64_t self_ns;
  };
  std::vector<Open> open = {{nullptr, 0, 0}};
  const auto cover = [&](std::int64_t begin_ns) {
    Open& top = open.back();
    if (begin_ns > top.covered_to_ns) {
      gap(top.span, top.covered_to_ns, begin_ns);
      top.self_ns += begin_ns - top.covered_to_ns;
    }
  };
  const auto close = [&] {
    const SpanRecord& span = *open.back().span;
    cover(span.end_ns);
    leave(span, open.back().self_ns);
    open.pop_back();
    open.back().covered_to_ns = span.end_ns;
  };
  for (const SpanRecord& span : spans) {
    while (open.back().span != nullptr && open.back().span->end_ns <= span.begin_ns) {
      close();
    }
    cover(span.begin_ns);
    open.push_back({&span, span.begin_ns, 0});
  }
  while (open.back().span != nullptr) {
    close();
  }
  cover(wall_ns);
}

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

void add(const StageShare& share, TraceSummary::Stage& stage) {
  stage.seconds += seconds(share.duration_ns);
  stage.columns += share.columns;
  stage.own_columns += share.own_columns;
  stage.work.cells += share.columns * share.column_work.cells;
  stage.work.operations += share.columns * share.column_work.operations;
  stage.work.bytes += share.columns * share.column_work.bytes;
}

}  // namespace

void add_waits(TraceData& trace) {
  for (ThreadTrace& thread : trace.threads) {
    sort_from_outside(thread.spans);
    if (!thread.is_in_pool) {
      continue;
    }
    std::vector<SpanRecord> waits;
    walk(
        thread.spans, trace.wall_ns, [](const SpanRecord&, std::int64_t) {},
        [&](const SpanRecord* outer, std::int64_t begin_ns, std::int64_t end_ns) {
          if (outer != nullptr && outer->kind != SpanKind::kJoin) {
            return;
          }
          SpanRecord wait;
          wait.name = outer == nullptr ? "idle" : "wait for tasks";
          wait.kind = SpanKind::kWait;
          wait.begin_ns = begin_ns;
          wait.end_ns = end_ns;
          wait.place.frame = outer == nullptr ? -1 : outer->place.frame;
          waits.push_back(wait);
        });
    thread.spans.insert(thread.spans.end(), waits.begin(), waits.end());
    sort_from_outside(thread.spans);
  }
}

double TraceSummary::work_share() const {
  double work_s = 0;
  double all_s = 0;
  for (const Thread& thread : threads) {
    if (thread.is_in_pool) {
      work_s += thread.work_s;
      all_s += thread.work_s + thread.wait_s;
    }
  }
  return all_s > 0 ? work_s / all_s : 0;
}

TraceSummary summarise(const TraceData& trace) {
  TraceSummary summary;
  summary.wall_s = seconds(trace.wall_ns);
  for (const ThreadTrace& thread : trace.threads) {
    TraceSummary::Thread& totals =
        summary.threads.emplace_back(TraceSummary::Thread{thread.name, thread.is_in_pool});
    walk(
        thread.spans, trace.wall_ns,
        [&](const SpanRecord& span, std::int64_t self_ns) {
          const bool is_wait = span.kind == SpanKind::kWait;
          if (span.kind != SpanKind::kJoin) {
            (is_wait ? totals.wait_s : totals.work_s) += seconds(self_ns);
            TraceSummary::Named& named =
                (is_wait ? summary.waits : summary.work)[std::string(span.name)];
            named.self_s += seconds(self_ns);
            named.processor_s += seconds(span.processor_ns);
            ++named.count;
          }
          if (span.kind == SpanKind::kWork) {
            summary.frame_work_s[span.place.frame] += seconds(self_ns);
          }
          for (std::size_t k = 0; k < span.stage_count; ++k) {
            const StageShare& share = thread.stages[span.first_stage + k];
            add(share, summary.stages[std::string(share.name)]);
          }
        },
        [](const SpanRecord*, std::int64_t, std::int64_t) {});
  }
  return summary;
}

}  // namespace vantage::scheduler
