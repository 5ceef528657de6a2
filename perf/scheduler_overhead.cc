// Scheduling overhead without work: empty tasks, empty stages of a chain, empty steps of frames,
// plans; and the cost of spans with and without a trace. All contenders of a table are interleaved
// in one run. Each executor has its own table, because waiting threads of one would occupy
// processors of the next. Prints tables; --json FILE writes the numbers.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/matching/stereo_matcher.h"
#include "perf/bench_pair.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/interleaved.h"
#include "perf/tables.h"
#include "scheduler/executor.h"
#include "scheduler/frame_pipeline.h"
#include "scheduler/strip_pipeline.h"
#include "scheduler/strip_plan.h"
#include "scheduler/trace.h"

namespace vantage::perf {
namespace {

using scheduler::Executor;
using scheduler::ExecutorKind;

struct Settings {
  int rounds = 11;
  int threads = scheduler::detect_machine().hardware_threads;
};

std::string on_threads(const Executor& executor) {
  return fmt::format("{}, {} thread{}", executor.name(), executor.thread_count(),
                     executor.thread_count() > 1 ? "s" : "");
}

nlohmann::json empty_tasks(Executor& executor, int rounds) {
  constexpr int kTasks = 4096;  // approximate number over all loops of a round
  std::vector<Contender> contenders;
  std::vector<double> work;
  for (const int per_thread : {1, 4, 16, 64}) {
    const int tasks = per_thread * executor.thread_count();
    const int loops = std::max(1, kTasks / tasks);
    contenders.push_back({fmt::format("{} tasks", tasks), [&executor, tasks, loops] {
                            for (int loop = 0; loop < loops; ++loop) {
                              executor.parallel_for(
                                  tasks, [](int task) { benchmark::DoNotOptimize(task); });
                            }
                          }});
    work.push_back(static_cast<double>(tasks) * loops);
  }
  return print_table("loops of empty tasks: " + on_threads(executor),
                     time_interleaved(contenders, rounds), work, "task");
}

/// A stage that computes nothing.
class EmptyStage final : public scheduler::RowStage {
 public:
  EmptyStage(scheduler::Extent extent, bool is_last) : RowStage(extent), is_last_(is_last) {}
  [[nodiscard]] std::string_view name() const override { return "empty"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return is_last_ ? 0 : 64; }
  void make_row(const scheduler::RowTask& task) const override {
    benchmark::DoNotOptimize(task.output);
  }

 private:
  bool is_last_;
};

class EmptyChain {
 public:
  EmptyChain(scheduler::Extent extent, int stages) {
    for (int k = 0; k < stages; ++k) {
      stages_.push_back(std::make_unique<EmptyStage>(extent, k + 1 == stages));
      chain_.push_back(stages_.back().get());
    }
  }
  [[nodiscard]] scheduler::Chain stages() const { return chain_; }

 private:
  std::vector<std::unique_ptr<EmptyStage>> stages_;
  std::vector<const scheduler::RowStage*> chain_;
};

nlohmann::json empty_stages(Executor& executor, int rounds) {
  constexpr int kStages = 8;
  constexpr int kStripColumns = 64;
  constexpr int kBandRows = 64;
  const int threads = executor.thread_count();
  scheduler::ScratchPool scratch;
  std::vector<std::unique_ptr<EmptyChain>> chains;
  std::vector<Contender> contenders;
  std::vector<double> work;
  for (const int per_thread : {1, 4, 16, 64}) {
    const scheduler::Extent extent{kStripColumns * threads, kBandRows * per_thread};
    chains.push_back(std::make_unique<EmptyChain>(extent, kStages));
    scheduler::PlanRequest request;
    request.threads = threads;
    request.strip_columns = kStripColumns;
    request.band_rows = kBandRows;
    request.pass_ends = std::vector<int>{};
    const auto plan = plan_chain(chains.back()->stages(), scheduler::detect_machine(), request);
    contenders.push_back({fmt::format("{} tasks", per_thread * threads),
                          [chain = chains.back().get(), plan, &executor, &scratch] {
                            run_strips(chain->stages(), plan, executor, scratch);
                          }});
    work.push_back(static_cast<double>(extent.rows) * threads * kStages);
  }
  return print_table(fmt::format("{} empty stages, tasks of {} rows, ns per row of a stage: {}",
                                 kStages, kBandRows, on_threads(executor)),
                     time_interleaved(contenders, rounds), work, "row");
}

nlohmann::json empty_frames(Executor& executor, int rounds) {
  constexpr int kFrames = 1000;
  std::vector<Contender> contenders;
  for (const int in_flight : {1, 2, 8}) {
    contenders.push_back({fmt::format("{} in flight", in_flight), [&executor, in_flight] {
                            int left = kFrames;
                            const auto nothing = [](int slot) { benchmark::DoNotOptimize(slot); };
                            scheduler::FrameSteps steps;
                            steps.read = [&left](int /*slot*/) { return left-- > 0; };
                            steps.prepare = steps.compute = steps.encode = steps.write = nothing;
                            run_frames(executor, in_flight, steps);
                          }});
  }
  return print_table("frames with empty steps: " + on_threads(executor),
                     time_interleaved(contenders, rounds), kFrames, "frame");
}

nlohmann::json plans(const Settings& settings) {
  constexpr int kPlans = 20;
  const scheduler::Machine machine = scheduler::detect_machine();
  std::vector<std::unique_ptr<EmptyChain>> chains;
  std::vector<Contender> contenders;
  for (const int stages : {2, 12, 52}) {
    chains.push_back(
        std::make_unique<EmptyChain>(scheduler::Extent{.columns = 1282, .rows = 1110}, stages));
    contenders.push_back({fmt::format("{} stages", stages),
                          [chain = chains.back().get(), &machine, threads = settings.threads] {
                            for (int k = 0; k < kPlans; ++k) {
                              scheduler::PlanRequest request;
                              request.threads = threads;
                              benchmark::DoNotOptimize(
                                  plan_chain(chain->stages(), machine, request));
                            }
                          }});
  }
  return print_table("choosing a plan, 1282x1110", time_interleaved(contenders, settings.rounds),
                     kPlans, "plan");
}

/// Times spans with and without a trace; returns the table. `idle_span_ns`: cost of a span without
/// a trace.
nlohmann::json spans(const Settings& settings, double& idle_span_ns) {
  constexpr int kSpans = 200'000;
  const auto make_spans = [] {
    for (int k = 0; k < kSpans; ++k) {
      const scheduler::Span span("empty");
      benchmark::ClobberMemory();
    }
  };
  const auto timings = time_interleaved({{"a loop without spans",
                                          [] {
                                            for (int k = 0; k < kSpans; ++k) {
                                              benchmark::ClobberMemory();
                                            }
                                          }},
                                         {"spans, no trace", make_spans},
                                         {"spans, recorded",
                                          [&make_spans] {
                                            scheduler::Trace trace;
                                            make_spans();
                                            benchmark::DoNotOptimize(trace.finish());
                                          }}},
                                        settings.rounds);
  idle_span_ns = (timings[1].median() - timings[0].median()) / kSpans * 1e9;
  return print_table("spans", timings, kSpans, "span");
}

/// Times a map without and with a recorded trace, and counts its spans.
nlohmann::json traced_maps(const Settings& settings, double idle_span_ns) {
  constexpr int kWidth = 450;
  constexpr int kHeight = 375;
  constexpr int kDisparities = 64;
  const Pair pair = make_pair(kWidth, kHeight, kDisparities);
  Execution execution({.threads = settings.threads});
  nlohmann::json results = nlohmann::json::array();
  for (const MatchMethod method : {MatchMethod::kSsd, MatchMethod::kBayes}) {
    MatchOptions options;
    options.method = method;
    options.disparities = {0, kDisparities - 1};
    options.raw = true;
    const StereoMatcher matcher(options, execution);
    DisparityMaps maps;
    const auto run = [&] {
      matcher.match(pair.left_grey, pair.right_grey,
                    {.left = true, .right = false, .unmatched = false}, maps);
    };
    std::size_t recorded = 0;
    const auto timings = time_interleaved({{"no trace", run},
                                           {"trace recorded",
                                            [&] {
                                              scheduler::Trace trace;
                                              run();
                                              recorded = 0;
                                              for (const auto& thread : trace.finish().threads) {
                                                recorded += thread.spans.size();
                                              }
                                            }}},
                                          settings.rounds);
    const char* name = method == MatchMethod::kSsd ? "SSD" : "Bayes";
    nlohmann::json table =
        print_table(fmt::format("{}, {}x{}, {} disparities, {} threads", name, kWidth, kHeight,
                                kDisparities, settings.threads),
                    timings, static_cast<double>(kWidth) * kHeight * kDisparities);
    const double share =
        static_cast<double>(recorded) * idle_span_ns * 1e-9 / timings.front().median();
    fmt::print("{} spans a map; without a trace they cost {:.2g} of its time\n", recorded, share);
    table["spans"] = recorded;
    table["share_without_trace"] = share;
    results.push_back(std::move(table));
  }
  return results;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  using namespace vantage::perf;
  CommandLine line("Empty tasks, stages and frames on every executor; plans; spans and traces");
  std::optional<std::string> json_path;
  Settings settings;
  line.rounds(settings.rounds);
  line.threads(settings.threads);
  line.json(json_path);
  line.parse(argc, argv);
  double idle_span_ns = 0;
  nlohmann::json tables = nlohmann::json::array();
  for (const ExecutorKind kind :
       {ExecutorKind::kSerial, ExecutorKind::kTbb, ExecutorKind::kOpenMp}) {
    const auto executor = make_executor(kind, settings.threads);
    tables.push_back(empty_tasks(*executor, settings.rounds));
    tables.push_back(empty_stages(*executor, settings.rounds));
    tables.push_back(empty_frames(*executor, settings.rounds));
  }
  tables.push_back(plans(settings));
  tables.push_back(spans(settings, idle_span_ns));
  for (auto& table : traced_maps(settings, idle_span_ns)) {
    tables.push_back(std::move(table));
  }
  write_json(json_path, tables);
  return 0;
}
