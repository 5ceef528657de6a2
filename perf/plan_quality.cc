// Quality of the cost model's plans. For several sizes and methods, compares the default plan with
// the best of a sweep over strips, bands and iterations per pass that does not use the cost model;
// the best plan is timed once more, in turn with the default. --bad-starts also starts the tuner
// from bad plans and reports how much of the best it recovers. --json FILE writes the numbers.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/simd.h"
#include "engine/tuning/match_subject.h"
#include "engine/tuning/tuner.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/speed_methods.h"
#include "perf/stopwatch.h"

namespace vantage::perf {
namespace {

struct Size {
  int width = 0;
  int height = 0;
  int disparities = 0;
};

constexpr std::array<Size, 5> kSizes = {
    {{450, 375, 64}, {640, 480, 64}, {1282, 1110, 256}, {1920, 1080, 128}, {1920, 1080, 256}}};

struct Settings {
  std::vector<Size> sizes{kSizes.begin(), kSizes.end()};
  std::string only;    ///< substring of the names of the methods to run; empty: all
  int rounds = 7;      ///< of the final comparison
  double seconds = 8;  ///< approximate duration of one sweep; longer frames are measured on images
                       ///< of reduced height
  bool bad_starts = false;
  double tune_seconds = 10;  ///< budget of one search from a bad start
  std::optional<int> threads;
  std::optional<int> l2_kib;  ///< default plans are for a level 2 of this size
  std::optional<std::string> json;
};

// Widths and heights that divide the image equally; each number of parts is about this factor times
// the previous one.
constexpr double kPartsStep = 1.4;
constexpr int kMinStripColumns = 16;
constexpr std::array kBands = {1, 2, 3, 4, 6, 8, 12, 16};
constexpr std::array kIterationsPerPass = {1, 2, 3, 5, 10};
// This many of the sweep's best strips are combined, at full height, with all band heights; then
// this many of the results are compared with the default.
constexpr std::size_t kBestStrips = 2;
constexpr std::size_t kFinalists = 3;
// Minimum height of the images of reduced height in the sweep.
constexpr int kMinRows = 128;

int divide_up(int total, int part) { return (total + part - 1) / part; }

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Settings and the frame time with them.
struct Measured {
  TunedSettings settings = {};
  double seconds = 0;
  double expected = 0;            ///< by the cost model, in its units
  std::size_t scratch_bytes = 0;  ///< maximum of the passes
};

void sort_by_time(std::vector<Measured>& all) { std::ranges::sort(all, {}, &Measured::seconds); }

/// Frame times per settings, measured in turn.
using Rounds = std::map<std::string, std::vector<double>>;

/// A size and a method, at full and at reduced height.
class Case {
 public:
  Case(const SpeedMethod& method, const Size& size, const Settings& settings)
      : method_(method), size_(size), settings_(settings) {
    ExecutionOptions execution;
    execution.threads = settings.threads;
    Execution threads(execution);
    pair_ = make_tuning_pair(size.width, size.height, method.options.disparities, true, threads);
    subject_ = std::make_unique<MatchSubject>(
        MatchSubjectOptions{.match = method.options, .execution = execution}, pair_);
    const double frame_seconds = measure(*subject_, {});
    const int rows = std::max(kMinRows, static_cast<int>(size.height * settings.seconds /
                                                         (frame_seconds * kSweepFrames)));
    sweep_rows_ = std::min(size.height, rows);
    lower_pair_ = top_rows(pair_, sweep_rows_);
    lower_ = std::make_unique<MatchSubject>(
        MatchSubjectOptions{.match = method.options, .execution = execution}, lower_pair_);
  }

  nlohmann::json run() {
    std::vector<Measured> finalists = sweep();
    std::vector<TunedSettings> contenders = {TunedSettings{}};
    for (std::size_t i = 0; i < std::min(kFinalists, finalists.size()); ++i) {
      contenders.push_back(finalists[i].settings);
    }
    std::vector<std::pair<std::string, TunedSettings>> recovered;
    if (settings_.bad_starts) {
      for (const auto& [name, start] : bad_starts()) {
        recovered.emplace_back(name, tune_from(start));
        contenders.push_back(start);
        contenders.push_back(recovered.back().second);
      }
    }
    const Rounds rounds = race(contenders);
    return report(rounds, finalists, recovered);
  }

 private:
  // Approximate number of plans per sweep, times two measurements each.
  static constexpr double kSweepFrames = 160;

  /// Of one thread the time in which it ran: other programs take the rest.
  [[nodiscard]] double measure(MatchSubject& subject, const TunedSettings& settings) const {
    const double processor = processor_seconds();
    const double begin = now_seconds();
    const double seconds = subject.measure(settings);
    const double share = (processor_seconds() - processor) / (now_seconds() - begin);
    return settings_.threads == 1 ? seconds * std::min(1.0, share) : seconds;
  }

  [[nodiscard]] Measured planned(const TunedSettings& settings, const TuningPair& pair) const {
    Execution execution(with_tuned({.threads = settings_.threads}, settings));
    const scheduler::ChainPlan plan =
        StereoMatcher(method_.options, execution).plan(pair.left, pair.right);
    Measured one{.settings = settings, .expected = total_expected_time(plan)};
    for (const scheduler::PassPlan& pass : plan.passes) {
      one.scratch_bytes = std::max(one.scratch_bytes, pass.scratch_bytes);
    }
    return one;
  }

  [[nodiscard]] bool is_iterative() const {
    return aggregation_of(method_.options.resolved()).is_iterative;
  }

  /// All strips × iterations per pass × bands, measured at full height, fastest first.
  std::vector<Measured> sweep() {
    std::vector<std::optional<int>> iterations = {std::nullopt};
    if (is_iterative()) {
      iterations.assign(kIterationsPerPass.begin(), kIterationsPerPass.end());
    }
    std::vector<Measured> strips;
    for (double parts = 1; size_.width / parts >= kMinStripColumns;
         parts = std::max(parts + 1, parts * kPartsStep)) {
      const int strip_px = divide_up(size_.width, static_cast<int>(parts));
      for (const std::optional<int>& of_pass : iterations) {
        Measured one =
            planned({.strip_width_px = strip_px, .iterations_per_pass = of_pass}, lower_pair_);
        one.seconds = measure(*lower_, one.settings);
        strips.push_back(one);
      }
    }
    sort_by_time(strips);
    for (const Measured& one : strips) {
      swept_.push_back({{"settings", to_string(one.settings)},
                        {"scratch_bytes", one.scratch_bytes},
                        {"expected", one.expected},
                        {"seconds", one.seconds}});
    }
    std::vector<Measured> all;
    for (std::size_t i = 0; i < std::min(kBestStrips, strips.size()); ++i) {
      TunedSettings settings = strips[i].settings;
      all.push_back({settings, measure(*subject_, settings)});
      for (const int bands : kBands) {
        settings.band_height_px = divide_up(size_.height, bands);
        all.push_back({settings, measure(*subject_, settings)});
      }
    }
    sort_by_time(all);
    return all;
  }

  [[nodiscard]] std::vector<std::pair<std::string, TunedSettings>> bad_starts() const {
    std::vector<std::pair<std::string, TunedSettings>> starts = {
        {"strips of 8", {.strip_width_px = 8}},
        {"bands of 8", {.band_height_px = 8}},
        {"whole width", {.strip_width_px = size_.width, .band_height_px = size_.height}},
        {"strips of 8, bands of 8", {.strip_width_px = 8, .band_height_px = 8}},
        {"one thread", {.threads = 1}}};
    if (is_iterative()) {
      starts.push_back({"pass by pass", {.iterations_per_pass = 1}});
      starts.push_back(
          {"pass by pass, strips of 8", {.strip_width_px = 8, .iterations_per_pass = 1}});
    }
    return starts;
  }

  /// Result of the search from `start`. Called without the tuner's final comparison with the
  /// default plan, which would hide the quality of the search.
  TunedSettings tune_from(const TunedSettings& start) {
    const TuningClock clock = now_seconds;
    Tuner tuner(*subject_, *subject_, clock,
                {.budget_seconds = settings_.tune_seconds, .start = start});
    TunedSettings end = start;
    tuner.on_progress([&](const TunerProgress& progress) { end = progress.incumbent; });
    tuner.tune();
    return end;
  }

  Rounds race(const std::vector<TunedSettings>& contenders) {
    Rounds rounds;
    for (int round = 0; round <= settings_.rounds; ++round) {
      std::map<std::string, double> seconds;
      for (const TunedSettings& contender : contenders) {
        const std::string name = to_string(contender);
        if (!seconds.contains(name)) {
          seconds[name] = measure(*subject_, contender);
        }
      }
      for (const auto& [name, time] : seconds) {
        if (round > 0) {  // the first round warms up
          rounds[name].push_back(time);
        }
      }
    }
    return rounds;
  }

  [[nodiscard]] nlohmann::json report(
      const Rounds& rounds, const std::vector<Measured>& finalists,
      const std::vector<std::pair<std::string, TunedSettings>>& recovered) {
    const auto of_settings = [&](const TunedSettings& settings) -> const std::vector<double>& {
      return rounds.at(to_string(settings));
    };
    TunedSettings best;
    for (std::size_t i = 0; i < std::min(kFinalists, finalists.size()); ++i) {
      const TunedSettings& one = finalists[i].settings;
      if (median(of_settings(one)) < median(of_settings(best))) {
        best = one;
      }
    }
    const auto over_best = [&](const TunedSettings& settings) {
      std::vector<double> values;
      for (std::size_t round = 0; round < of_settings(best).size(); ++round) {
        values.push_back(of_settings(settings)[round] / of_settings(best)[round]);
      }
      return values;
    };
    const std::vector<double> of_default = over_best({});
    const std::string default_plan = plan_text();
    fmt::print("{:<24} {:>9.2f} {:>19}  {:<24} {}\n", method_.name, 1e3 * median(of_settings({})),
               with_range(of_default, 3), default_plan, to_string(best));
    nlohmann::json result = {{"method", method_.name},
                             {"width", size_.width},
                             {"height", size_.height},
                             {"disparities", size_.disparities},
                             {"sweep_rows", sweep_rows_},
                             {"default_seconds", figures(of_settings({}))},
                             {"default_plan", default_plan},
                             {"best", to_string(best)},
                             {"sweep", swept_},
                             {"default_over_best", figures(of_default)}};
    if (settings_.bad_starts) {
      const auto starts = bad_starts();
      for (std::size_t i = 0; i < recovered.size(); ++i) {
        const auto& [name, found] = recovered[i];
        fmt::print("  from {:<26} {:>19} to {:>19}  {}\n", name,
                   with_range(over_best(starts[i].second), 3), with_range(over_best(found), 3),
                   to_string(found));
        result["bad_starts"].push_back({{"start", name},
                                        {"start_over_best", figures(over_best(starts[i].second))},
                                        {"found", to_string(found)},
                                        {"found_over_best", figures(over_best(found))}});
      }
    }
    std::fflush(stdout);
    return result;
  }

  /// Describes the default plan.
  [[nodiscard]] std::string plan_text() const {
    Execution execution({.threads = settings_.threads});
    const StereoMatcher matcher(method_.options, execution);
    const scheduler::ChainPlan plan = matcher.plan(pair_.left, pair_.right);
    const scheduler::PassPlan& pass = plan.passes.front();
    return fmt::format("{}x{}, {} passes{}", pass.strip_columns, pass.band_rows, plan.passes.size(),
                       plan.steps > 1 ? " in steps" : "");
  }

  const SpeedMethod& method_;
  Size size_;
  const Settings& settings_;
  int sweep_rows_ = 0;
  TuningPair pair_;
  TuningPair lower_pair_;
  std::unique_ptr<MatchSubject> subject_;
  std::unique_ptr<MatchSubject> lower_;
  nlohmann::json swept_ = nlohmann::json::array();
};

/// Has plans made for this machine with another level 2.
void pretend_l2(int kib) {
  const scheduler::Machine machine = scheduler::detect_machine();
  const std::string topology = fmt::format(
      "Package:1 L3Cache:1(size={}) L2Cache:{}(size={}) L1dCache:1(size={}) Core:1 PU:1",
      machine.l3_bytes, machine.cores, std::size_t{1024} * kib, machine.l1_data_bytes);
  ::setenv("HWLOC_SYNTHETIC", topology.c_str(), 1);
}

int run_benchmark(int argc, char** argv) {
  CommandLine line("The default plan against the best of a sweep over strips, bands and passes");
  Settings settings;
  std::optional<std::string> wanted_size;
  line.option("--size", wanted_size, "WIDTHxHEIGHTxDISPARITIES instead of five sizes");
  line.only(settings.only, "Only methods whose names contain this");
  line.number("--rounds", settings.rounds, "Rounds of the final comparison");
  line.option("--seconds", settings.seconds, "Approximate duration of one sweep");
  line.number("--threads", settings.threads, "Threads; all by default");
  line.number("--l2", settings.l2_kib,
              "KiB of level 2 that default plans are for; the machine's own");
  line.flag("--bad-starts", settings.bad_starts, "Where the tuner's search ends from bad plans");
  line.option("--tune-seconds", settings.tune_seconds, "Time of one search of the tuner");
  line.json(settings.json);
  line.parse(argc, argv);
  if (wanted_size) {
    Size size;
    if (std::sscanf(wanted_size->c_str(), "%dx%dx%d", &size.width, &size.height,
                    &size.disparities) != 3) {
      line.refuse(fmt::format("--size is '{}', expected WIDTHxHEIGHTxDISPARITIES", *wanted_size));
    }
    settings.sizes = {size};
  }
  if (settings.l2_kib) {
    pretend_l2(*settings.l2_kib);
  }
  fmt::print("instruction set {}, {} threads\n", instruction_set_in_use(),
             settings.threads.value_or(scheduler::detect_machine().hardware_threads));
  nlohmann::json results = nlohmann::json::array();
  for (const Size& size : settings.sizes) {
    fmt::print("\n{}x{}, {} disparities\n{:<24} {:>9} {:>19}  {:<24} {}\n", size.width, size.height,
               size.disparities, "", "default", "default / best", "default plan", "best found");
    for (const SpeedMethod& method : speed_methods(size.disparities, settings.only)) {
      results.push_back(Case(method, size, settings).run());
    }
  }
  write_json(settings.json, results);
  return 0;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) { return vantage::perf::run_benchmark(argc, argv); }
