// Who waited for what, and timelines, on made-up traces in milliseconds.

#include "engine/profiling/waiting_causes.h"

#include "engine/profiling/timeline.h"
#include "scheduler/trace_summary.h"
#include "tests/engine/engine_test.h"

namespace vantage::waiting_causes_test {

using scheduler::SpanKind;
using scheduler::SpanRecord;
using scheduler::ThreadTrace;
using scheduler::TraceData;

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr double kTolerance_s = 1e-12;

SpanRecord span(std::string_view name, int begin_ms, int end_ms, SpanKind kind = SpanKind::kWork,
                int frame = -1) {
  SpanRecord record;
  record.name = name;
  record.kind = kind;
  record.begin_ns = begin_ms * kMillisecond;
  record.end_ns = end_ms * kMillisecond;
  record.place.frame = frame;
  return record;
}

/// A trace of 100 ms; the waits of its threads are added.
TraceData trace_of(std::vector<ThreadTrace> threads) {
  TraceData trace;
  trace.wall_ns = 100 * kMillisecond;
  trace.threads = std::move(threads);
  scheduler::add_waits(trace);
  return trace;
}

ThreadTrace pool_thread(std::vector<SpanRecord> spans) {
  return {"pool", true, std::move(spans), {}};
}

TEST(WaitingCauses, AreWhatTheOthersDoMeanwhile) {
  const TraceData trace = trace_of({
      pool_thread(
          {span("read frame", 0, 10), span("compute frame", 10, 60), span("encode frame", 60, 90)}),
      pool_thread({span("compute frame", 20, 40)}),
  });
  const WaitingCauses causes = waiting_causes(trace);
  EXPECT_NEAR(causes.reading_s, 0.010, kTolerance_s);
  EXPECT_NEAR(causes.computing_s, 0.030, kTolerance_s);  // 10..20 and 40..60
  EXPECT_NEAR(causes.writing_s, 0.030, kTolerance_s);
  EXPECT_NEAR(causes.nothing_s, 0.020, kTolerance_s);  // 90..100, both
}

TEST(WaitingCauses, AreDividedAmongThoseWhoWork) {
  const TraceData trace = trace_of({
      pool_thread({span("decode", 0, 100)}),
      pool_thread({span("match left", 0, 100)}),
      pool_thread({span("match left", 0, 100)}),
      pool_thread({}),
  });
  const WaitingCauses causes = waiting_causes(trace);
  EXPECT_NEAR(causes.reading_s, 0.1 / 3, kTolerance_s);
  EXPECT_NEAR(causes.computing_s, 0.2 / 3, kTolerance_s);
}

TEST(WaitingCauses, CountWorkByItsInnermostSpan) {
  const TraceData trace = trace_of({
      pool_thread({span("prepare frame", 0, 100), span("decode", 0, 30), span("rectify", 30, 100)}),
      pool_thread({}),
  });
  const WaitingCauses causes = waiting_causes(trace);
  EXPECT_NEAR(causes.reading_s, 0.03, kTolerance_s);
  EXPECT_NEAR(causes.computing_s, 0.07, kTolerance_s);
}

TEST(WaitingCauses, AskOtherThreadsOnlyWhereThePoolRests) {
  const ThreadTrace deliveries = {"deliveries", false, {span("deliver", 0, 80)}, {}};
  const TraceData trace =
      trace_of({pool_thread({span("match left", 0, 50)}), pool_thread({}), deliveries});
  const WaitingCauses causes = waiting_causes(trace);
  EXPECT_NEAR(causes.computing_s, 0.050, kTolerance_s);
  EXPECT_NEAR(causes.writing_s, 0.060, kTolerance_s);  // 50..80, both
  EXPECT_NEAR(causes.nothing_s, 0.040, kTolerance_s);
}

TEST(WaitingCauses, TakeTheDiskForWriting) {
  const TraceData trace = trace_of({
      pool_thread({span("write frame", 0, 100), span("disk", 10, 40, SpanKind::kWait)}),
      pool_thread({span("match left", 0, 100)}),
  });
  const WaitingCauses causes = waiting_causes(trace);
  EXPECT_NEAR(causes.writing_s, 0.030, kTolerance_s);
  EXPECT_NEAR(causes.sum_s(), 0.030, kTolerance_s);
}

TEST(WaitingCauses, AreAllTheWaitingThereIs) {
  const TraceData trace = trace_of({
      pool_thread({span("frames", 5, 97, SpanKind::kJoin), span("read frame", 7, 13),
                   span("compute frame", 20, 71), span("parallel for", 22, 70, SpanKind::kJoin),
                   span("match left", 30, 41)}),
      pool_thread({span("match left", 23, 55), span("encode frame", 60, 61)}),
      pool_thread({span("decode", 3, 31)}),
  });
  double waiting_s = 0;
  for (const auto& [name, wait] : scheduler::summarise(trace).waits) {
    waiting_s += wait.self_s;
  }
  EXPECT_GT(waiting_s, 0.1);
  EXPECT_NEAR(waiting_causes(trace).sum_s(), waiting_s, 1e-9);
}

TEST(Timeline, ShowsTheInnermostOfThreads) {
  const TraceData trace = trace_of({pool_thread({span("frames", 0, 90, SpanKind::kJoin),
                                                 span("compute frame", 10, 80, SpanKind::kWork, 4),
                                                 span("match left", 20, 60, SpanKind::kWork, 4)})});
  const std::vector<TimelineRow> rows = timeline_of(trace);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_TRUE(rows[0].is_in_pool);
  std::vector<std::string> names;
  double end_s = 0;
  for (const TimelineSpan& one : rows[0].spans) {
    names.push_back(one.name);
    EXPECT_NEAR(one.begin_s, end_s, 1e-9);
    end_s = one.end_s;
    EXPECT_EQ(one.is_wait, one.name == "wait for tasks" || one.name == "idle");
    EXPECT_EQ(one.frame, one.is_wait ? -1 : 4);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"wait for tasks", "compute frame", "match left",
                                             "compute frame", "wait for tasks", "idle"}));
  EXPECT_NEAR(end_s, 0.1, 1e-9);
}

TEST(Timeline, JoinsWhatIsTooShort) {
  // A thousand tasks of 70 µs with waits of 30 µs between them, then one long task.
  std::vector<SpanRecord> spans;
  for (int i = 0; i < 500; ++i) {
    SpanRecord task = span("match left", 0, 0);
    task.begin_ns = i * kMillisecond / 10;
    task.end_ns = task.begin_ns + 70'000;
    spans.push_back(task);
  }
  spans.push_back(span("write", 50, 100));
  const TraceData trace = trace_of({pool_thread(spans)});
  constexpr int kMax = 20;
  const std::vector<TimelineRow> rows = timeline_of(trace, kMax);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_LE(rows[0].spans.size(), 2U * kMax);
  EXPECT_EQ(rows[0].spans.front().name, "match left");
  EXPECT_EQ(rows[0].spans.front().begin_s, 0);
  EXPECT_EQ(rows[0].spans.back().name, "write");
  EXPECT_NEAR(rows[0].spans.back().begin_s, 0.05, 1e-9);
  EXPECT_NEAR(rows[0].spans.back().end_s, 0.1, 1e-9);
  EXPECT_GT(timeline_of(trace, 100'000)[0].spans.size(), 900U);
}

}  // namespace vantage::waiting_causes_test
