#include "scheduler/trace.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <thread>

#include "scheduler/frame_pipeline.h"
#include "scheduler/strip_pipeline.h"
#include "scheduler/trace_summary.h"
#include "tests/scheduler/executor_cases.h"
#include "tests/scheduler/test_chains.h"

namespace vantage::scheduler::trace_test {

using std::chrono::milliseconds;

/// Waits without giving up the thread: work.
void keep_busy(milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
  }
}

bool holds(const SpanRecord& outer, const SpanRecord& inner) {
  return outer.begin_ns <= inner.begin_ns && inner.end_ns <= outer.end_ns;
}

/// Every two spans of a thread lie apart or one in the other, and all lie in the trace.
void expect_nested(const TraceData& trace) {
  for (const ThreadTrace& thread : trace.threads) {
    for (const SpanRecord& a : thread.spans) {
      EXPECT_LE(0, a.begin_ns);
      EXPECT_LE(a.begin_ns, a.end_ns);
      EXPECT_LE(a.end_ns, trace.wall_ns);
      for (const SpanRecord& b : thread.spans) {
        const bool apart = a.end_ns <= b.begin_ns || b.end_ns <= a.begin_ns;
        EXPECT_TRUE(apart || holds(a, b) || holds(b, a))
            << thread.name << ": " << a.name << " and " << b.name;
      }
    }
  }
}

std::vector<SpanRecord> spans_named(const TraceData& trace, std::string_view name) {
  std::vector<SpanRecord> found;
  for (const ThreadTrace& thread : trace.threads) {
    for (const SpanRecord& span : thread.spans) {
      if (span.name == name) {
        found.push_back(span);
      }
    }
  }
  return found;
}

class TraceOfExecutor : public testing::TestWithParam<ExecutorCase> {};

TEST_P(TraceOfExecutor, HasEveryTaskOnceWithNameAndFrameOfItsLoop) {
  const auto executor = GetParam().make();
  constexpr int kTasks = 23;
  Trace trace;
  {
    const Span span("outer", SpanKind::kWork, {.frame = 5});
    executor->parallel_for(kTasks, [](int) { keep_busy(milliseconds(1)); });
  }
  const TraceData data = trace.finish();

  expect_nested(data);
  std::multiset<int> tasks;
  for (const SpanRecord& span : spans_named(data, "outer")) {
    EXPECT_EQ(span.place.frame, 5);
    if (span.place.task >= 0) {
      tasks.insert(span.place.task);
      EXPECT_GE(span.end_ns - span.begin_ns, 900'000);
    }
  }
  EXPECT_EQ(tasks.size(), kTasks);
  EXPECT_EQ(std::set<int>(tasks.begin(), tasks.end()).size(), kTasks);
  EXPECT_EQ(spans_named(data, "parallel for").size(), 1U);
  EXPECT_EQ(data.threads.front().name, "main");
}

TEST_P(TraceOfExecutor, WorkAndWaitsOfPoolThreadsAddUpToTheWallTime) {
  const auto executor = GetParam().make();
  Trace trace;
  keep_busy(milliseconds(2));
  {
    const Span span("outer");
    executor->parallel_for(7, [&](int) {
      keep_busy(milliseconds(1));
      executor->parallel_for(3, [](int) { keep_busy(milliseconds(1)); });
    });
  }
  TraceData data = trace.finish();
  add_waits(data);

  expect_nested(data);
  const TraceSummary summary = summarise(data);
  double work_s = 0;
  for (const TraceSummary::Thread& thread : summary.threads) {
    if (thread.is_in_pool) {
      EXPECT_NEAR(thread.work_s + thread.wait_s, summary.wall_s, 1e-9) << thread.name;
    }
    work_s += thread.work_s;
  }
  EXPECT_GE(work_s, 0.9 * 28e-3);
  EXPECT_NEAR(summary.work.at("outer").self_s, work_s, 1e-9);
  EXPECT_EQ(summary.work.at("outer").count, 1 + 7 + 21);
  EXPECT_GT(summary.work_share(), 0);
  EXPECT_LE(summary.work_share(), 1);
}

TEST_P(TraceOfExecutor, HasTheStepsOfEveryFrame) {
  const auto executor = GetParam().make();
  constexpr int kFrames = 6;
  int read = 0;
  FrameSteps steps;
  steps.read = [&](int) { return read++ < kFrames; };
  steps.prepare = [](int) {};
  steps.compute = [&](int) { executor->parallel_for(4, [](int) { keep_busy(milliseconds(1)); }); };
  steps.encode = [](int) {};
  steps.write = [](int) {};
  Trace trace;
  run_frames(*executor, 3, steps);
  TraceData data = trace.finish();
  add_waits(data);

  expect_nested(data);
  for (const std::string_view name :
       {"read frame", "prepare frame", "compute frame", "encode frame", "write frame"}) {
    std::map<int, int> count_of_frame;
    for (const SpanRecord& span : spans_named(data, name)) {
      ++count_of_frame[span.place.frame];
    }
    // Reading is asked once more, for the end.
    EXPECT_EQ(count_of_frame.size(), name == "read frame" ? kFrames + 1U : kFrames) << name;
    for (int frame = 0; frame < kFrames; ++frame) {
      EXPECT_EQ(count_of_frame[frame], name == "compute frame" ? 5 : 1) << name << " of " << frame;
    }
  }
  const TraceSummary summary = summarise(data);
  for (int frame = 0; frame < kFrames; ++frame) {
    EXPECT_GE(summary.frame_work_s.at(frame), 0.9 * 4e-3);
  }
}

TEST_P(TraceOfExecutor, HasStripsBandsAndPassesWithTheirStages) {
  const auto executor = GetParam().make();
  TestChain chain({29, 13});
  chain.add<FloatSource>(chain.extent());
  chain.add<Box>(1, chain.extent());
  chain.add<Box>(2, chain.extent());
  chain.finish();
  PlanRequest request;
  request.strip_columns = 10;
  request.band_rows = 5;
  request.pass_ends = {2};
  ScratchPool scratch;
  Trace trace;
  run_strips(chain.stages(), plan_chain(chain.stages(), Machine{}, request), *executor, scratch);
  const TraceData data = trace.finish();

  std::multiset<std::vector<int>> places;
  int stages = 0;
  double columns = 0;
  double own_columns = 0;
  for (const ThreadTrace& thread : data.threads) {
    for (const SpanRecord& span : thread.spans) {
      if (span.place.strip >= 0) {
        places.insert({span.place.pass, span.place.strip, span.place.first_row});
        std::int64_t stages_ns = 0;
        for (std::size_t k = 0; k < span.stage_count; ++k) {
          const StageShare& share = thread.stages[span.first_stage + k];
          EXPECT_GT(share.rows, 0);
          stages_ns += share.duration_ns;
          columns += share.columns;
          own_columns += share.own_columns;
        }
        stages += static_cast<int>(span.stage_count);
        EXPECT_LE(stages_ns, span.end_ns - span.begin_ns);
      }
    }
  }
  std::multiset<std::vector<int>> expected;
  for (int pass = 0; pass < 2; ++pass) {
    for (int strip = 0; strip < 3; ++strip) {
      for (const int first_row : {0, 5, 10}) {
        expected.insert({pass, strip, first_row});
      }
    }
  }
  EXPECT_EQ(places, expected);
  EXPECT_EQ(stages, 9 * 4);
  // Halo columns and rows come on top of what the chain delivers.
  const Extent extent = chain.extent();
  EXPECT_EQ(own_columns, 4.0 * extent.columns * extent.rows);
  EXPECT_GT(columns, own_columns);
}

INSTANTIATE_TEST_SUITE_P(Executors, TraceOfExecutor, testing::ValuesIn(executor_cases()),
                         executor_test_name);

TEST(Trace, RecordsNothingBeforeAndAfterIt) {
  { const Span span("before"); }
  EXPECT_FALSE(Trace::is_active());
  Trace trace;
  EXPECT_TRUE(Trace::is_active());
  { const Span span("within"); }
  const TraceData data = trace.finish();
  EXPECT_FALSE(Trace::is_active());
  { const Span span("after"); }
  EXPECT_EQ(Span::innermost(), nullptr);
  ASSERT_EQ(data.threads.size(), 1U);
  ASSERT_EQ(data.threads[0].spans.size(), 1U);
  EXPECT_EQ(data.threads[0].spans[0].name, "within");
}

TEST(Trace, OneAfterTheOtherKeepsThemApart) {
  for (int round = 0; round < 3; ++round) {
    Trace trace;
    { const Span span("round", SpanKind::kWork, {.frame = round}); }
    const TraceData data = trace.finish();
    ASSERT_EQ(data.threads.at(0).spans.size(), 1U);
    EXPECT_EQ(data.threads[0].spans[0].place.frame, round);
  }
}

TEST(Trace, DropsSpansBeyondItsLimitButNoneAroundThoseItKeeps) {
  Trace trace(3);
  {
    const Span outer("outer");
    for (int k = 0; k < 5; ++k) {
      const Span inner("inner");
    }
  }
  const TraceData data = trace.finish();
  EXPECT_EQ(data.dropped_spans, 3);
  EXPECT_EQ(spans_named(data, "outer").size(), 1U);
  EXPECT_EQ(spans_named(data, "inner").size(), 2U);
}

TEST(Trace, NamesThreadsOutsideOfThePool) {
  Trace trace;
  std::thread([] {
    name_traced_thread("flushing");
    const Span span("flush", SpanKind::kWait);
  }).join();
  TraceData data = trace.finish();
  ASSERT_EQ(data.threads.size(), 2U);
  EXPECT_EQ(data.threads[1].name, "flushing");
  EXPECT_FALSE(data.threads[1].is_in_pool);
  add_waits(data);
  EXPECT_EQ(data.threads[1].spans.size(), 1U);
  EXPECT_EQ(summarise(data).waits.at("flush").count, 1);
}

TEST(Trace, ChargesProcessorTimeToTheInnermostSpan) {
  const auto run_for = [](std::int64_t nanoseconds) {
    const std::int64_t end = thread_time_ns() + nanoseconds;
    while (thread_time_ns() < end) {
    }
  };
  Trace trace;
  const std::int64_t before = thread_time_ns();
  std::int64_t within = 0;
  {
    const Span outer("outer");
    const std::int64_t begin = thread_time_ns();
    for (int i = 0; i < 2; ++i) {
      const Span inner("inner");
      run_for(2'000'000);
    }
    run_for(1'000'000);
    within = thread_time_ns() - begin;
  }
  const std::int64_t around = thread_time_ns() - before;
  const TraceSummary summary = summarise(trace.finish());
  const double outer_s = summary.work.at("outer").processor_s;
  const double inner_s = summary.work.at("inner").processor_s;
  EXPECT_GE(inner_s, 0.004);
  EXPECT_GE(outer_s, 0.001);
  EXPECT_GE(outer_s + inner_s, 1e-9 * static_cast<double>(within) - 1e-12);
  EXPECT_LE(outer_s + inner_s, 1e-9 * static_cast<double>(around) + 1e-12);
}

TEST(TraceSummary, CountsWhatSpansWithinDoNotCover) {
  TraceData data;
  data.wall_ns = 100;
  ThreadTrace& thread = data.threads.emplace_back();
  thread.name = "main";
  thread.is_in_pool = true;
  const auto add = [&](std::string_view name, SpanKind kind, std::int64_t begin_ns,
                       std::int64_t end_ns) {
    SpanRecord span;
    span.name = name;
    span.kind = kind;
    span.begin_ns = begin_ns;
    span.end_ns = end_ns;
    thread.spans.push_back(span);
  };
  add("task", SpanKind::kWork, 30, 50);  // 15 without the wait
  add("disk", SpanKind::kWait, 35, 40);
  add("task", SpanKind::kWork, 55, 60);
  add("loop", SpanKind::kJoin, 20, 70);
  add("step", SpanKind::kWork, 10, 80);
  add_waits(data);

  const TraceSummary summary = summarise(data);
  EXPECT_NEAR(summary.work.at("step").self_s * 1e9, 20, 1e-6);
  EXPECT_NEAR(summary.work.at("task").self_s * 1e9, 20, 1e-6);
  EXPECT_NEAR(summary.waits.at("disk").self_s * 1e9, 5, 1e-6);
  EXPECT_NEAR(summary.waits.at("wait for tasks").self_s * 1e9, 10 + 5 + 10, 1e-6);
  EXPECT_NEAR(summary.waits.at("idle").self_s * 1e9, 10 + 20, 1e-6);
  EXPECT_EQ(summary.waits.at("idle").count, 2);
  EXPECT_NEAR(summary.threads[0].work_s * 1e9, 40, 1e-6);
  EXPECT_NEAR(summary.threads[0].wait_s * 1e9, 60, 1e-6);
  EXPECT_NEAR(summary.work_share(), 0.4, 1e-9);
}

}  // namespace vantage::scheduler::trace_test
