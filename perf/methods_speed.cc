// Speed of the iterative and evidence methods: against OpenCV's StereoSGBM on the same pair and
// threads, against themselves pass by pass, and as a function of the number of iterations. All
// contenders of a table are interleaved in one run. Prints tables; --json FILE writes the numbers.

#include <fmt/format.h>

#include <memory>
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

constexpr int kWidth = 450;
constexpr int kHeight = 375;
constexpr int kDisparities = 64;
constexpr double kCells = static_cast<double>(kWidth) * kHeight * kDisparities;

struct Method {
  std::string name;
  MatchOptions options;
  double work = 1;  ///< unit of the speed target: cells, or cells × iterations
};

Method make_method(std::string name, MatchMethod method, int iterations) {
  Method result{std::move(name), {}, kCells * std::max(1, iterations)};
  result.options.method = method;
  result.options.parameters.subpixel = Subpixel::kNone;
  if (method == MatchMethod::kBayes) {
    result.options.parameters.sigma_prior = 0.1;
  }
  if (iterations > 0) {
    result.options.parameters.iterations = iterations;
  }
  result.options.disparities = {0, kDisparities - 1};
  result.options.raw = true;
  return result;
}

std::vector<Method> all_methods() {
  std::vector<Method> methods;
  const auto add = [&](std::string name, MatchMethod method, int iterations) -> MethodOverrides& {
    methods.push_back(make_method(std::move(name), method, iterations));
    return methods.back().options.parameters;
  };
  add("Bayes, sigma-prior 0.1", MatchMethod::kBayes, 10);
  add("Bayes, sigma-prior 0.4", MatchMethod::kBayes, 10).sigma_prior = 0.4;
  add("Bayes, mu 0.45", MatchMethod::kBayes, 10).mu = 0.45;
  add("membrane", MatchMethod::kMembrane, 10);
  add("diffusion", MatchMethod::kDiffusion, 10);
  add("local stopping, margin", MatchMethod::kLocalStopping, 10);
  add("local stopping, entropy", MatchMethod::kLocalStopping, 10).certainty = Certainty::kEntropy;
  add("gradient, box cascade", MatchMethod::kGradient, 0);
  add("gradient, Gaussian", MatchMethod::kGradient, 0).aggregation = Aggregation::kGaussian;
  add("census, box 9x9", MatchMethod::kSsd, 0).cost = MatchCost::kCensus;
  return methods;
}

/// Runs the chain with the whole-image executor: stores every row of every stage, one thread.
void run_whole_image_chain(const Method& method, const Pair& pair, Execution& execution) {
  const MethodParameters parameters = method.options.resolved();
  const auto geometry = candidate_geometry(method.options.in_force(), Side::kLeft, kWidth, kHeight);
  CostImage left;
  CostImage right;
  left.prepare(pair.left_grey, parameters, geometry, {true, false, false}, execution);
  right.prepare(pair.right_grey, parameters, geometry, {false, true, false}, execution);
  DisparityMap map(kWidth, kHeight);
  const MatchChain chain(parameters, geometry, {nullptr, &left, {CostPartner{&right}}},
                         {map.view(), {}, {}});
  scheduler::run_whole_image(chain.stages());
}

/// Times every method on one thread, on all threads, and pass by pass on all threads.
nlohmann::json against_peers(const Pair& pair, int rounds) {
  const int threads = scheduler::detect_machine().hardware_threads;
  const cv::Mat left = to_opencv(pair.left_grey);
  const cv::Mat right = to_opencv(pair.right_grey);
  cv::Mat result;
  const auto sgbm = make_sgbm({0, kDisparities - 1}, 5, 1, cv::StereoSGBM::MODE_SGBM_3WAY);
  const auto run_sgbm = [&](int sgbm_threads) {
    cv::setNumThreads(sgbm_threads);
    sgbm->compute(left, right, result);
    cv::setNumThreads(1);
  };
  const std::vector<Method> methods = all_methods();
  std::vector<std::unique_ptr<MapRunner>> runners;
  std::vector<Contender> contenders{
      {fmt::format("StereoSGBM 3-way, {} threads", threads), [&] { run_sgbm(threads); }},
      {"StereoSGBM 3-way, 1 thread", [&] { run_sgbm(1); }}};
  std::vector<double> work{kCells, kCells};
  const auto add = [&](const Method& method, const ExecutionOptions& execution,
                       const std::string& how) {
    runners.push_back(std::make_unique<MapRunner>(method.options, execution));
    contenders.push_back({method.name + how, [&pair, runner = runners.back().get()] {
                            runner->run(pair.left_grey, pair.right_grey);
                          }});
    work.push_back(method.work);
  };
  Execution serial({.threads = 1});
  for (const Method& method : methods) {
    add(method, {.threads = threads}, fmt::format(", {} threads", threads));
    add(method, {.threads = 1}, ", 1 thread");
    if (method.work > kCells) {
      ExecutionOptions pass_by_pass{.threads = threads};
      pass_by_pass.iterations_per_pass = 1;
      add(method, pass_by_pass, ", pass by pass");
    }
  }
  contenders.push_back({"Bayes, whole-image executor, 1 thread",
                        [&] { run_whole_image_chain(methods.front(), pair, serial); }});
  work.push_back(methods.front().work);
  return print_table("450x375, 64 disparities, one map; ns per cell and iteration",
                     time_interleaved(contenders, rounds), work);
}

nlohmann::json over_iterations(const Pair& pair, int rounds) {
  const int threads = scheduler::detect_machine().hardware_threads;
  nlohmann::json tables = nlohmann::json::array();
  for (const MatchMethod kind : {MatchMethod::kBayes, MatchMethod::kMembrane}) {
    std::vector<Method> methods;
    std::vector<std::unique_ptr<MapRunner>> runners;
    std::vector<Contender> contenders;
    std::vector<double> work;
    for (const int iterations : {10, 50, 200}) {
      methods.push_back(make_method(fmt::format("{} iterations", iterations), kind, iterations));
      runners.push_back(std::make_unique<MapRunner>(methods.back().options,
                                                    ExecutionOptions{.threads = threads}));
      contenders.push_back({methods.back().name, [&pair, runner = runners.back().get()] {
                              runner->run(pair.left_grey, pair.right_grey);
                            }});
      work.push_back(methods.back().work);
    }
    tables.push_back(
        print_table(fmt::format("{} over iterations, {} threads; ns per cell and iteration",
                                kind == MatchMethod::kBayes ? "Bayes" : "membrane", threads),
                    time_interleaved(contenders, rounds), work));
    for (std::size_t i = 0; i < runners.size(); ++i) {
      const auto& plan = runners[i]->report().plan;
      fmt::print("{}: {} passes, strips {} columns wide, bands {} rows high\n", methods[i].name,
                 plan.passes.size(), plan.passes.front().strip_columns,
                 plan.passes.front().band_rows);
    }
  }
  return tables;
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  using namespace vantage::perf;
  CommandLine line("The iterative and evidence methods against StereoSGBM and pass by pass");
  std::optional<std::string> json_path;
  int rounds = 11;
  line.rounds(rounds);
  line.json(json_path);
  line.parse(argc, argv);
  cv::setNumThreads(1);
  fmt::print("instruction set {}, {} hardware threads\n", vantage::instruction_set_in_use(),
             vantage::scheduler::detect_machine().hardware_threads);
  const Pair pair = make_pair(kWidth, kHeight, kDisparities);
  nlohmann::json tables = nlohmann::json::array();
  tables.push_back(against_peers(pair, rounds));
  for (auto& table : over_iterations(pair, std::max(3, rounds / 3))) {
    tables.push_back(std::move(table));
  }
  write_json(json_path, tables);
  return 0;
}
