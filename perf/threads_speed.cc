// Speed-up by threads on one pair: every method on one thread and on all, beside as many
// independent one-thread matchers with a pair each, whose gain is the maximum that the machine
// allows. Then both maps with refinement. All interleaved; --json FILE writes the numbers.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/matching/stereo_matcher.h"
#include "engine/simd.h"
#include "perf/bench_pair.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/speed_methods.h"
#include "perf/stopwatch.h"

namespace vantage::perf {
namespace {

struct Settings {
  int width = 1282;
  int height = 1110;
  int disparities = 256;
  int rounds = 7;
  int threads = scheduler::detect_machine().hardware_threads;
  std::string only;  ///< substring of the names of the rows to run; empty: all
  std::optional<std::string> json;
};

/// A matcher on its own threads.
class Worker {
 public:
  Worker(const MatchOptions& options, const ExecutionOptions& execution)
      : execution_(execution), matcher_(options, execution_) {}
  void run(const Pair& pair) {
    const bool refined = matcher_.in_force().refinement.has_value();
    matcher_.match(pair.left_grey, pair.right_grey,
                   {.left = true, .right = refined, .unmatched = refined}, maps_, &report_);
  }
  [[nodiscard]] const MatchReport& report() const { return report_; }

 private:
  Execution execution_;
  StereoMatcher matcher_;
  DisparityMaps maps_;
  MatchReport report_;
};

/// Seconds per part, summed over rounds.
using PartSeconds = std::vector<std::pair<std::string, double>>;

void add_parts(const MatchReport& report, PartSeconds& parts) {
  parts.resize(std::max(parts.size(), report.stages.size()));
  for (std::size_t i = 0; i < report.stages.size(); ++i) {
    parts[i].first = report.stages[i].name;
    parts[i].second += report.stages[i].seconds;
  }
}

/// One method: alone on one thread, on all threads, and once per thread side by side.
class Row {
 public:
  Row(const SpeedMethod& method, const Settings& settings)
      : name_(method.name),
        one_(method.options, {.threads = 1}),
        all_(method.options, {.threads = settings.threads}) {
    for (int i = 0; i < settings.threads; ++i) {
      strangers_.push_back(std::make_unique<Worker>(
          method.options, ExecutionOptions{.executor = scheduler::ExecutorKind::kSerial}));
    }
  }

  void warm_up(const Pair& pair) {
    one_.run(pair);
    all_.run(pair);
    run_strangers(pair);
  }

  void time_round(const Pair& pair) {
    const Stopwatch one;
    one_.run(pair);
    one_times_.push_back(one.per_frame(1));
    const Stopwatch all;
    all_.run(pair);
    all_times_.push_back(all.per_frame(1));
    const Stopwatch strangers;
    run_strangers(pair);
    stranger_times_.push_back(strangers.per_frame(static_cast<int>(strangers_.size())));
    add_parts(one_.report(), one_parts_);
    add_parts(all_.report(), all_parts_);
  }

  [[nodiscard]] nlohmann::json print() const {
    const std::vector<double> speed_up = ratios(one_times_, all_times_);
    const std::vector<double> limit = ratios(one_times_, stranger_times_);
    const std::vector<double> share = ratios(stranger_times_, all_times_);
    const auto wall = [](const std::vector<FrameTime>& times) {
      return of(times, &FrameTime::wall);
    };
    const auto& pass = all_.report().plan.passes.front();
    const std::string plan = fmt::format("{}x{}, {} passes", pass.strip_columns, pass.band_rows,
                                         all_.report().plan.passes.size());
    fmt::print("{:<28} {:>8.1f} {:>8.1f} {:>17} {:>17} {:>17}  {}\n", name_,
               1e3 * median(wall(one_times_)), 1e3 * median(wall(all_times_)), with_range(speed_up),
               with_range(limit), with_range(share), plan);
    nlohmann::json parts = nlohmann::json::array();
    for (std::size_t i = 0; i < all_parts_.size() && all_parts_.size() > 2; ++i) {
      fmt::print("  {:<26} {:>8.1f} {:>8.1f} {:>6.2f}\n", all_parts_[i].first,
                 1e3 * one_parts_[i].second / static_cast<double>(one_times_.size()),
                 1e3 * all_parts_[i].second / static_cast<double>(one_times_.size()),
                 one_parts_[i].second / all_parts_[i].second);
      parts.push_back({{"name", all_parts_[i].first},
                       {"speed_up", one_parts_[i].second / all_parts_[i].second}});
    }
    return {{"name", name_},
            {"one_thread_seconds", figures(wall(one_times_))},
            {"all_threads_seconds", figures(wall(all_times_))},
            {"speed_up", figures(speed_up)},
            {"speed_up_of_strangers", figures(limit)},
            {"share_of_strangers", figures(share)},
            {"plan", plan},
            {"parts", parts}};
  }

 private:
  void run_strangers(const Pair& pair) {
    std::vector<std::jthread> threads;
    for (const auto& stranger : strangers_) {
      threads.emplace_back([&pair, &stranger] { stranger->run(pair); });
    }
  }

  std::string name_;
  Worker one_;
  Worker all_;
  std::vector<std::unique_ptr<Worker>> strangers_;
  std::vector<FrameTime> one_times_, all_times_, stranger_times_;
  PartSeconds one_parts_, all_parts_;
};

std::vector<SpeedMethod> wanted_rows(const Settings& settings) {
  std::vector<SpeedMethod> rows = speed_methods(settings.disparities, settings.only);
  const auto add = [&](const std::string& name, const MatchOptions& options) {
    if (name.find(settings.only) != std::string::npos) {
      rows.push_back({name, options});
      rows.back().options.disparities = {0, settings.disparities - 1};
    }
  };
  MatchOptions refined;
  add("both maps, ssd", refined);
  refined.preset = MatchPreset::kBalanced;
  add("both maps, preset balanced", refined);
  refined.preset = MatchPreset::kBalanced;
  add("both maps, preset balanced", refined);
  return rows;
}

nlohmann::json compare(const Settings& settings) {
  const Pair pair = make_pair(settings.width, settings.height, settings.disparities);
  fmt::print("\n{}x{}, {} disparities, {} rounds: median (range)\n", settings.width,
             settings.height, settings.disparities, settings.rounds);
  fmt::print("{:<28} {:>8} {:>8} {:>17} {:>17} {:>17}  {}\n", "", "1: ms",
             fmt::format("{}: ms", settings.threads), "speed-up", "of strangers", "share", "plan");
  nlohmann::json rows = nlohmann::json::array();
  for (const SpeedMethod& method : wanted_rows(settings)) {
    Row row(method, settings);
    row.warm_up(pair);
    for (int round = 0; round < settings.rounds; ++round) {
      row.time_round(pair);
    }
    rows.push_back(row.print());
    std::fflush(stdout);
  }
  return {{"width", settings.width},
          {"height", settings.height},
          {"disparities", settings.disparities},
          {"threads", settings.threads},
          {"rounds", settings.rounds},
          {"rows", rows}};
}

int run_benchmark(int argc, char** argv) {
  CommandLine line("One thread against all on one pair, and against independent matchers");
  Settings settings;
  line.size(settings.width, settings.height);
  line.number("--disparities", settings.disparities, "Candidate disparities");
  line.rounds(settings.rounds);
  line.threads(settings.threads);
  line.only(settings.only, "Only rows whose names contain this");
  line.json(settings.json);
  line.parse(argc, argv);
  fmt::print("instruction set {}, {} hardware threads\n", instruction_set_in_use(),
             scheduler::detect_machine().hardware_threads);
  const nlohmann::json table = compare(settings);
  write_json(settings.json, table);
  return 0;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) { return vantage::perf::run_benchmark(argc, argv); }
