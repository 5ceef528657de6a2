#include "engine/figures/pair_runs.h"

#include <fmt/format.h>

#include <iterator>

#include "engine/matching/options/method_fields.h"

namespace vantage {
namespace {

ComparisonOptions comparison_of(const FigureSettings& settings) {
  return {.pairs = settings.pairs,
          .noise_sigmas = settings.noise_sigmas,
          .methods = settings.methods,
          .iterations = settings.iterations,
          .size_px = settings.size_px.value(),
          .seed = settings.seed.value(),
          .parameters = settings.parameters};
}

}  // namespace

double noise_in_force(double noise_sigma, const std::string& pair) {
  constexpr double kRampNoise = 1;
  if (noise_sigma != kBookNoise) {
    return noise_sigma;
  }
  return pair.starts_with("ramp") ? kRampNoise : 0;
}

std::vector<ComparisonRun> runs_of(const FigureRun& run, const MethodOverrides& more) {
  std::vector<ComparisonRun> all;
  for (const std::string& pair : run.settings.pairs) {
    ComparisonOptions options = comparison_of(run.settings);
    options.pairs = {pair};
    for (double& sigma : options.noise_sigmas) {
      sigma = noise_in_force(sigma, pair);
    }
    take_over(more, options.parameters);
    auto runs = compare_methods(options, run.execution, run.stop);
    if (runs.empty()) {
      return {};
    }
    std::move(runs.begin(), runs.end(), std::back_inserter(all));
  }
  return all;
}

std::string iterations_field(const std::string& method, int iterations) {
  return compared_method(method).is_iterative ? fmt::format("{}", iterations) : "";
}

bool differ_in_iterations(const ComparisonRun& a, const ComparisonRun& b) {
  return a.pair == b.pair && a.noise_sigma == b.noise_sigma && a.method == b.method;
}

FigureTable table_of(const std::vector<ComparisonRun>& runs) {
  FigureTable table{"",
                    {"pair", "method", "iterations", "noise_sigma", "mean_absolute_px", "rms_px",
                     "bad_percent", "evaluated_pixels"}};
  for (const ComparisonRun& run : runs) {
    table.add(run.pair, run.method, iterations_field(run.method, run.iterations), run.noise_sigma,
              fmt::format("{:.6f}", run.scores.average_px),
              fmt::format("{:.6f}", run.scores.rms_px),
              fmt::format("{:.4f}", run.scores.bad_0_5_percent), run.scores.evaluated_pixels);
  }
  return table;
}

std::string noise_label(double sigma) {
  return sigma == 0.25 ? "1/4" : sigma == 0.5 ? "1/2" : fmt::format("{}", sigma);
}

double percent_where(const DisparityMap& map,
                     const std::function<bool(int x, int y, float disparity)>& holds) {
  int pixels = 0;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      pixels += holds(x, y, map.at(x, y)) ? 1 : 0;
    }
  }
  return 100.0 * pixels / (map.width() * map.height());
}

BookPair pair_of(const FigureSettings& settings, const std::string& pair, double noise_sigma) {
  ComparisonOptions options;
  options.size_px = settings.size_px.value();
  options.seed = settings.seed.value();
  return make_book_pair(comparison_pair(options, pair, noise_in_force(noise_sigma, pair)));
}

}  // namespace vantage
