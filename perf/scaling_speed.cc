// Growth of the time per map with width, height, disparities, iterations and window on one thread
// (fitted exponents), and over threads with fixed work (strong scaling) and with equal work per
// thread (weak scaling). All contenders of a table are interleaved in one run. Prints tables;
// --json FILE writes the numbers.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/simd.h"
#include "perf/bench_pair.h"
#include "perf/command_line.h"
#include "perf/figures.h"
#include "perf/interleaved.h"
#include "perf/map_runner.h"
#include "perf/power_law.h"
#include "perf/stopwatch.h"
#include "perf/tables.h"

namespace vantage::perf {
namespace {

struct GreyPair {
  Photograph left;
  Photograph right;
};

/// Crops to the upper left corner.
Photograph corner(const Photograph& photograph, int width, int height) {
  const auto& from = std::get<Image<std::uint8_t>>(photograph.pixels);
  Image<std::uint8_t> result(width, height);
  for (int y = 0; y < height; ++y) {
    std::copy_n(from.row(y), width, result.row(y));
  }
  return {std::move(result)};
}

GreyPair corner(const Pair& pair, int width, int height) {
  return {corner(pair.left_grey, width, height), corner(pair.right_grey, width, height)};
}

MatchOptions method_options(MatchMethod method, int disparities) {
  MatchOptions options;
  options.method = method;
  options.disparities = {0, disparities - 1};
  options.raw = true;
  options.parameters.subpixel = Subpixel::kNone;
  if (method != MatchMethod::kSsd && method != MatchMethod::kGradient) {
    options.parameters.iterations = 10;
  }
  if (method == MatchMethod::kBayes) {
    options.parameters.sigma_prior = 0.1;
  }
  return options;
}

/// One point of a curve: a size and the input matched at it.
struct Point {
  double value = 0;
  int width = 960;
  int height = 540;
  MatchOptions options;
};

nlohmann::json fit_curve(const std::string& title, const Pair& pair,
                         const std::vector<Point>& points, int rounds) {
  std::vector<GreyPair> pairs;
  std::vector<std::unique_ptr<MapRunner>> runners;
  std::vector<Contender> contenders;
  std::vector<double> cells;
  std::vector<double> values;
  pairs.reserve(points.size());
  for (const Point& point : points) {
    pairs.push_back(corner(pair, point.width, point.height));
    runners.push_back(std::make_unique<MapRunner>(point.options, ExecutionOptions{.threads = 1}));
    contenders.push_back(
        {fmt::format("{}", point.value), [runner = runners.back().get(), images = &pairs.back()] {
           runner->run(images->left, images->right);
         }});
    cells.push_back(static_cast<double>(point.width) * point.height *
                    point.options.disparities.count() *
                    point.options.parameters.iterations.value_or(1));
    values.push_back(point.value);
  }
  const auto timings = time_interleaved(contenders, rounds);
  nlohmann::json table = print_table(title, timings, cells);
  std::vector<double> medians;
  for (const Timing& timing : timings) {
    medians.push_back(timing.median());
  }
  const PowerLaw law = fit_power_law(values, medians);
  fmt::print("time ~ x^{:.3f}, standard error {:.3f}\n", law.exponent, law.standard_error);
  table["exponent"] = law.exponent;
  table["standard_error"] = law.standard_error;
  return table;
}

nlohmann::json fit_curves(const Pair& pair, int rounds) {
  nlohmann::json tables = nlohmann::json::array();
  const auto fit = [&](const std::string& title, const std::vector<double>& values,
                       const auto& point_at) {
    std::vector<Point> points;
    for (const double value : values) {
      points.push_back(point_at(static_cast<int>(value)));
      points.back().value = value;
    }
    tables.push_back(fit_curve(title, pair, points, rounds));
  };
  constexpr int kDisparities = 64;
  for (const auto& [name, method] :
       {std::pair{"SSD 9x9", MatchMethod::kSsd}, {"Bayes, 10 iterations", MatchMethod::kBayes}}) {
    const MatchOptions options = method_options(method, kDisparities);
    fit(fmt::format("{}: width, at height 540, 64 disparities", name), {480, 720, 960, 1440, 1920},
        [&](int width) { return Point{.width = width, .options = options}; });
    fit(fmt::format("{}: height, at width 960, 64 disparities", name), {270, 405, 540, 810, 1080},
        [&](int height) { return Point{.height = height, .options = options}; });
    fit(fmt::format("{}: disparities, at 960x540", name), {32, 64, 96, 128, 192},
        [&](int disparities) { return Point{.options = method_options(method, disparities)}; });
  }
  for (const auto& [name, method] :
       {std::pair{"Bayes", MatchMethod::kBayes}, {"membrane", MatchMethod::kMembrane}}) {
    fit(fmt::format("{}: iterations, at 480x270, 64 disparities; per iteration", name),
        {4, 8, 16, 32}, [&](int iterations) {
          Point point{.width = 480, .height = 270, .options = method_options(method, kDisparities)};
          point.options.parameters.iterations = iterations;
          return point;
        });
  }
  const auto with_window = [](int window) {
    Point point{.width = 1920, .options = method_options(MatchMethod::kSsd, kDisparities)};
    point.options.parameters.window_px = window;
    return point;
  };
  fit("SSD: window, cells with room for their candidate's number, at 1920x540, 64 disparities",
      {5, 9, 15, 21}, with_window);
  fit("SSD: window, cells without, at 1920x540, 64 disparities", {23, 31, 51, 101}, with_window);
  return tables;
}

/// 1, 2, 4, … threads, and `max`.
std::vector<int> thread_counts(int max) {
  std::vector<int> counts;
  for (int threads = 1; threads < max; threads *= 2) {
    counts.push_back(threads);
  }
  counts.push_back(max);
  return counts;
}

/// Times of one method for several numbers of threads.
class ThreadScaling {
 public:
  ThreadScaling(std::string name, const MatchOptions& options, const GreyPair& pair,
                const std::vector<int>& counts)
      : name_(std::move(name)), counts_(counts) {
    const int height = pair.left.height();
    for (const int threads : counts) {
      // Work per thread equals that of all threads on the whole image.
      const int rows = height * threads / counts.back();
      parts_.push_back({corner(pair.left, pair.left.width(), rows),
                        corner(pair.right, pair.left.width(), rows)});
      runners_.push_back(
          std::make_unique<MapRunner>(options, ExecutionOptions{.threads = threads}));
    }
    for (std::size_t i = 0; i < counts.size(); ++i) {
      add(fmt::format("{}, {} threads", name_, counts[i]), i, pair);
      if (counts[i] != counts.back()) {
        add(fmt::format("{}, {} threads, {} of the rows", name_, counts[i],
                        fmt::format("{}/{}", counts[i], counts.back())),
            i, parts_[i]);
      }
    }
  }
  ThreadScaling(const ThreadScaling&) = delete;
  ThreadScaling& operator=(const ThreadScaling&) = delete;

  [[nodiscard]] nlohmann::json measure(int rounds) const {
    const auto timings = time_interleaved(contenders_, rounds);
    nlohmann::json rows = nlohmann::json::array();
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      const Timing& strong = timings[2 * i];
      const Timing& weak = i + 1 < counts_.size() ? timings[2 * i + 1] : strong;
      const auto speed_up = ratios(timings.front().by_round, strong.by_round);
      // One thread with its share of the rows.
      const Timing& share_of_one = counts_.size() > 1 ? timings[1] : timings[0];
      const auto efficiency = ratios(share_of_one.by_round, weak.by_round);
      const double threads = counts_[i];
      const double serial =
          threads > 1 ? (1 / median(speed_up) - 1 / threads) / (1 - 1 / threads) : 0;
      fmt::print("{:<26} {:>7} {:>10.1f} {:>20} {:>10.3f} {:>10.4f} {:>20}\n", name_, counts_[i],
                 1e3 * strong.median(), with_range(speed_up), median(speed_up) / threads, serial,
                 with_range(efficiency));
      rows.push_back({{"name", strong.name},
                      {"threads", counts_[i]},
                      {"min_seconds", strong.min()},
                      {"median_seconds", strong.median()},
                      {"max_seconds", strong.max()},
                      {"speed_up", figures(speed_up)},
                      {"serial_fraction", serial},
                      {"weak_efficiency", figures(efficiency)}});
    }
    return rows;
  }

 private:
  static std::vector<double> ratios(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> result;
    for (std::size_t i = 0; i < a.size(); ++i) {
      result.push_back(a[i] / b[i]);
    }
    return result;
  }

  void add(std::string name, std::size_t runner, const GreyPair& pair) {
    contenders_.push_back({std::move(name), [runner = runners_[runner].get(), &pair] {
                             runner->run(pair.left, pair.right);
                           }});
  }

  std::string name_;
  std::vector<int> counts_;
  std::vector<GreyPair> parts_;
  std::vector<std::unique_ptr<MapRunner>> runners_;
  std::vector<Contender>
      contenders_;  // per number of threads: all rows, then its share (except the last)
};

nlohmann::json over_threads(int width, int height, int disparities, const std::vector<int>& counts,
                            int rounds) {
  const GreyPair pair = corner(make_pair(width, height, disparities), width, height);
  const std::string title =
      fmt::format("{}x{}, {} disparities, over threads", width, height, disparities);
  fmt::print("\n{}\n{:<26} {:>7} {:>10} {:>20} {:>10} {:>10} {:>20}\n", title, "", "threads",
             "median ms", "speed-up", "efficiency", "serial", "weak efficiency");
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& [name, method] : {std::pair{"SSD 9x9", MatchMethod::kSsd},
                                     {"gradient evidence", MatchMethod::kGradient},
                                     {"membrane, 10", MatchMethod::kMembrane},
                                     {"local stopping, 10", MatchMethod::kLocalStopping},
                                     {"Bayes, 10", MatchMethod::kBayes}}) {
    const ThreadScaling scaling(name, method_options(method, disparities), pair, counts);
    for (auto& row : scaling.measure(rounds)) {
      rows.push_back(std::move(row));
    }
  }
  return {{"title", title}, {"rows", rows}};
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  using namespace vantage::perf;
  CommandLine line("Time against width, height, disparities, iterations and window; over threads");
  std::string only;
  int rounds = 3;
  int threads = vantage::scheduler::detect_machine().hardware_threads;
  std::optional<std::string> json_path;
  line.only(only, "Only this part: curves, 1282x1110 or 1920x1080");
  line.rounds(rounds);
  line.threads(threads);
  line.json(json_path);
  line.parse(argc, argv);
  const auto wanted = [&only](const std::string& part) { return only.empty() || only == part; };
  if (!wanted("curves") && !wanted("1282x1110") && !wanted("1920x1080")) {
    line.refuse(fmt::format("--only is '{}', expected curves, 1282x1110 or 1920x1080", only));
  }
  fmt::print("instruction set {}, {} threads\n", vantage::instruction_set_in_use(), threads);
  const std::vector<int> counts = thread_counts(threads);
  nlohmann::json tables = nlohmann::json::array();
  if (wanted("curves")) {
    tables = fit_curves(make_pair(1920, 1080, 128), rounds);
  }
  if (wanted("1282x1110")) {
    tables.push_back(over_threads(1282, 1110, 256, counts, rounds));
  }
  if (wanted("1920x1080")) {
    tables.push_back(over_threads(1920, 1080, 128, counts, rounds));
  }
  write_json(json_path, tables);
  return 0;
}
