// Speed of the presets, both refined maps and the left one alone, against one map of StereoSGBM in
// three-way mode, block 5, grey and colour, on all threads. All contenders of a size are
// interleaved in one run: each is called after a pause, and then several times without one, as for
// the frames of a camera and those of a file. Prints tables; --json FILE writes the numbers.

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "engine/matching/options/method_names.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/simd.h"
#include "perf/bench_pair.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/peers.h"

namespace vantage::perf {
namespace {

// Idle threads of the contender before may still be looking for work.
constexpr std::chrono::milliseconds kPause(30);
constexpr int kCallsInARow = 3;

/// One contender and its times, in order of measurement.
struct Timed {
  std::string name;
  std::function<void()> run;
  std::vector<FrameTime> after_pause = {};
  std::vector<FrameTime> rounds = {};  ///< of calls that follow each other at once
};

/// A preset on one pair of photographs.
class PresetRunner {
 public:
  PresetRunner(MatchPreset preset, int disparities, const MatchRequest& request,
               Execution& execution)
      : matcher_(options(preset, disparities), execution), request_(request) {}
  void run(const Photograph& left, const Photograph& right) {
    MatchReport report;
    matcher_.match(left, right, request_, maps_, &report);
    for (const StageTime& stage : report.stages) {
      stages_[std::string(stage.name)].push_back(stage.seconds);
    }
  }
  /// Of all calls, in no order.
  [[nodiscard]] const std::map<std::string, std::vector<double>>& stages() const { return stages_; }

 private:
  static MatchOptions options(MatchPreset preset, int disparities) {
    MatchOptions options;
    options.preset = preset;
    options.disparities = {0, disparities - 1};
    return options;
  }

  StereoMatcher matcher_;
  MatchRequest request_;
  DisparityMaps maps_;
  std::map<std::string, std::vector<double>> stages_;
};

nlohmann::json measure(int width, int height, int disparities, const std::string& only, int rounds,
                       Execution& execution) {
  const Pair pair = make_pair(width, height, disparities);
  const auto sgbm_of = [&](const Photograph& left, const Photograph& right, int channels) {
    return [left = to_opencv(left), right = to_opencv(right), result = cv::Mat(),
            sgbm = make_sgbm({0, disparities - 1}, 5, channels, cv::StereoSGBM::MODE_SGBM_3WAY),
            &execution]() mutable {
      // Setting them makes new threads.
      if (cv::getNumThreads() != execution.executor().thread_count()) {
        cv::setNumThreads(execution.executor().thread_count());
      }
      sgbm->compute(left, right, result);
    };
  };
  std::vector<Timed> contenders = {
      {"three-way, grey, one map", sgbm_of(pair.left_grey, pair.right_grey, 1)},
      {"three-way, colour, one map", sgbm_of(pair.left, pair.right, 3)}};
  std::vector<std::unique_ptr<PresetRunner>> runners;
  for (const auto& [name, preset] : names_of(MatchPreset{})) {
    if (std::string(name).find(only) == std::string::npos) {
      continue;
    }
    for (const bool both : {true, false}) {
      runners.push_back(std::make_unique<PresetRunner>(
          preset, disparities, MatchRequest{.left = true, .right = both}, execution));
      contenders.push_back(
          {fmt::format("{}, {}", name, both ? "both maps" : "left map"),
           [&pair, runner = runners.back().get()] { runner->run(pair.left, pair.right); }});
    }
  }
  for (int round = 0; round <= rounds; ++round) {
    for (Timed& one : contenders) {
      std::this_thread::sleep_for(kPause);
      const Stopwatch first;
      one.run();
      const FrameTime of_first = first.per_frame(1);
      const Stopwatch others;
      for (int call = 0; call < kCallsInARow; ++call) {
        one.run();
      }
      if (round > 0) {
        one.after_pause.push_back(of_first);
        one.rounds.push_back(others.per_frame(kCallsInARow));
      }
    }
  }
  const double megapixels = width * height * 1e-6;
  fmt::print(
      "\n{}x{}, {} candidates, {} threads, colour\n{:<28} {:>8} {:>11} {:>18} {:>18} {:>18}\n",
      width, height, disparities, execution.executor().thread_count(), "", "wall ms", "core s/Mpx",
      "to grey three-way", "to colour", "grey, after pause");
  nlohmann::json rows = nlohmann::json::array();
  for (const Timed& one : contenders) {
    const double wall = median(of(one.rounds, &FrameTime::wall));
    const double core = median(of(one.rounds, &FrameTime::processor)) / megapixels;
    const auto to_grey = ratios(one.rounds, contenders[0].rounds);
    const auto to_colour = ratios(one.rounds, contenders[1].rounds);
    const auto after_pause = ratios(one.after_pause, contenders[0].after_pause);
    fmt::print("{:<28} {:>8.2f} {:>11.4f} {:>18} {:>18} {:>18}\n", one.name, wall * 1e3, core,
               with_range(to_grey), with_range(to_colour), with_range(after_pause));
    rows.push_back({{"name", one.name},
                    {"median_seconds", wall},
                    {"core_seconds_per_megapixel", core},
                    {"ratio_to_grey_three_way", figures(to_grey)},
                    {"ratio_to_colour_three_way", figures(to_colour)},
                    {"ratio_to_grey_three_way_after_a_pause", figures(after_pause)}});
  }
  for (std::size_t i = 0; i < runners.size(); ++i) {
    std::string stages;
    for (const auto& [name, seconds] : runners[i]->stages()) {
      stages += fmt::format("  {} {:.2f}", name, median(seconds) * 1e3);
    }
    fmt::print("{}, median ms by stage:{}\n", contenders[i + 2].name, stages);
  }
  return {{"width", width}, {"height", height}, {"candidates", disparities}, {"rows", rows}};
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  using namespace vantage::perf;
  CommandLine line(
      "Presets, both refined maps and the left one alone, against one map of StereoSGBM three-way, "
      "block 5, grey and colour");
  int width = 0;
  int height = 0;
  int disparities = 128;
  std::string only;
  int threads = vantage::scheduler::detect_machine().hardware_threads;
  int rounds = 9;
  std::string isa = "best";
  std::optional<std::string> json_path;
  line.size(width, height, "Size of the images; by default 450x375 with 64 disparities, 1920x1080");
  line.number("--disparities", disparities, "Candidate disparities");
  line.only(only, "Only this preset");
  line.threads(threads);
  line.rounds(rounds);
  line.option("--isa", isa, "Instruction set of the kernels, as in vantage --isa");
  line.json(json_path);
  line.parse(argc, argv);
  vantage::force_instruction_set(isa);
  fmt::print("instruction set {}\n", vantage::instruction_set_in_use());
  vantage::Execution execution({.threads = threads});
  nlohmann::json tables = nlohmann::json::array();
  if (width > 0) {
    tables.push_back(measure(width, height, disparities, only, rounds, execution));
  } else {
    tables.push_back(measure(450, 375, 64, only, rounds, execution));
    tables.push_back(measure(1920, 1080, 128, only, rounds, execution));
  }
  write_json(json_path, tables);
  return 0;
}
