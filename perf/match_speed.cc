// Speed of SSD matching against OpenCV's matchers, against itself on two threads, and as a function
// of the window. All contenders of a table are interleaved in one run. Prints tables; --json FILE
// writes the numbers.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/simd.h"
#include "perf/bench_pair.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/interleaved.h"
#include "perf/map_runner.h"
#include "perf/peers.h"
#include "perf/tables.h"
#include "scheduler/whole_image_pipeline.h"

namespace vantage::perf {
namespace {

MatchOptions ssd_options(int disparities, int window, Subpixel subpixel) {
  MatchOptions result;
  result.method = MatchMethod::kSsd;
  result.disparities = {0, disparities - 1};
  result.parameters.window_px = window;
  result.parameters.subpixel = subpixel;
  result.raw = true;
  return result;
}

/// Runs a matcher's chain with the whole-image executor: pass by pass, storing every row of every
/// stage.
void run_whole_image_chain(const Photograph& left, const Photograph& right,
                           const MatchOptions& options, Execution& execution) {
  const auto geometry =
      candidate_geometry(options.in_force(), Side::kLeft, left.width(), left.height());
  const MethodParameters parameters = options.resolved();
  PreparedPair pair;
  pair.prepare(left, right, geometry, parameters.window_px * parameters.window_px, {true, false},
               execution);
  DisparityMap map(left.width(), left.height());
  const MatchChain chain(parameters, geometry, {&pair, nullptr, {}}, {map.view(), {}, {}});
  scheduler::run_whole_image(chain.stages());
}

nlohmann::json against_peers(int rounds) {
  constexpr int width = 450;
  constexpr int height = 375;
  constexpr int disparities = 64;
  const Pair pair = make_pair(width, height, disparities);
  const cv::Mat left = to_opencv(pair.left_grey);
  const cv::Mat right = to_opencv(pair.right_grey);
  cv::Mat result;
  const auto bm = make_bm({0, disparities - 1}, 9);
  const auto bm_winner_only = make_bm({0, disparities - 1}, 9);
  bm_winner_only->setUniquenessRatio(0);
  bm_winner_only->setTextureThreshold(0);
  const auto sgbm = make_sgbm({0, disparities - 1}, 5, 1, cv::StereoSGBM::MODE_SGBM_3WAY);
  const MatchOptions options = ssd_options(disparities, 9, Subpixel::kNone);
  MapRunner winner(options, {.threads = 1});
  MapRunner parabola(ssd_options(disparities, 9, Subpixel::kParabola), {.threads = 1});
  MapRunner colour(options, {.threads = 1});
  Execution serial({.threads = 1});
  const auto timings = time_interleaved(
      {{"StereoBM, block 9, its defaults", [&] { bm->compute(left, right, result); }},
       {"StereoBM, winner only", [&] { bm_winner_only->compute(left, right, result); }},
       {"StereoSGBM 3-way, block 5", [&] { sgbm->compute(left, right, result); }},
       {"Vantage SSD 9x9, winner only", [&] { winner.run(pair.left_grey, pair.right_grey); }},
       {"Vantage SSD 9x9, parabola", [&] { parabola.run(pair.left_grey, pair.right_grey); }},
       {"Vantage SSD 9x9, colour input", [&] { colour.run(pair.left, pair.right); }},
       {"Vantage SSD 9x9, whole-image executor",
        [&] { run_whole_image_chain(pair.left_grey, pair.right_grey, options, serial); }}},
      rounds);
  return print_table("450x375, 64 disparities, one thread, one map", timings,
                     static_cast<double>(width) * height * disparities);
}

nlohmann::json over_threads(int rounds) {
  constexpr int width = 1282;
  constexpr int height = 1110;
  constexpr int disparities = 256;
  const Pair pair = make_pair(width, height, disparities);
  std::vector<std::unique_ptr<MapRunner>> maps;
  std::vector<Contender> contenders;
  const int hardware = scheduler::detect_machine().hardware_threads;
  for (int threads = 1; threads <= hardware; threads *= 2) {
    maps.push_back(std::make_unique<MapRunner>(ssd_options(disparities, 9, Subpixel::kNone),
                                               ExecutionOptions{.threads = threads}));
    contenders.push_back(
        {fmt::format("{} thread{}", threads, threads > 1 ? "s" : ""),
         [&pair, map = maps.back().get()] { map->run(pair.left_grey, pair.right_grey); }});
  }
  return print_table("1282x1110, 256 disparities, SSD 9x9, winner only",
                     time_interleaved(contenders, rounds),
                     static_cast<double>(width) * height * disparities);
}

nlohmann::json over_windows(int rounds) {
  constexpr int width = 640;
  constexpr int height = 480;
  constexpr int disparities = 64;
  const Pair pair = make_pair(width, height, disparities);
  std::vector<std::unique_ptr<MapRunner>> maps;
  std::vector<Contender> contenders;
  for (const int window : {3, 5, 9, 15, 21, 31, 51, 101}) {
    maps.push_back(std::make_unique<MapRunner>(ssd_options(disparities, window, Subpixel::kNone),
                                               ExecutionOptions{.threads = 1}));
    contenders.push_back({fmt::format("window {}", window), [&pair, map = maps.back().get()] {
                            map->run(pair.left_grey, pair.right_grey);
                          }});
  }
  return print_table("640x480, 64 disparities, one thread, over windows",
                     time_interleaved(contenders, rounds),
                     static_cast<double>(width) * height * disparities);
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  using namespace vantage::perf;
  CommandLine line("SSD against OpenCV's StereoBM and StereoSGBM, over threads and windows");
  std::optional<std::string> json_path;
  int rounds = 15;
  line.rounds(rounds);
  line.json(json_path);
  line.parse(argc, argv);
  cv::setNumThreads(1);
  fmt::print("instruction set {}, {} hardware threads\n", vantage::instruction_set_in_use(),
             vantage::scheduler::detect_machine().hardware_threads);
  nlohmann::json tables = nlohmann::json::array();
  tables.push_back(against_peers(rounds));
  tables.push_back(over_threads(std::max(3, rounds / 3)));
  tables.push_back(over_windows(rounds));
  write_json(json_path, tables);
  return 0;
}
