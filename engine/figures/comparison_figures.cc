#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/figures/figure_families.h"
#include "engine/figures/pair_runs.h"
#include "engine/io/images/preview.h"
#include "engine/plot/line_plot.h"
#include "engine/plot/picture_sheet.h"

namespace vantage {
namespace {

constexpr int kChartColumns = 3;

/// A measure of error.
struct ErrorMeasure {
  std::string_view name;   ///< in file names
  std::string_view title;  ///< on axes
  double DisparityScores::*value;
};
constexpr ErrorMeasure kMeanAbsolute = {"mean-absolute", "mean |error|, pixels",
                                        &DisparityScores::average_px};
constexpr ErrorMeasure kRms = {"rms", "RMS error, pixels", &DisparityScores::rms_px};
constexpr ErrorMeasure kBad = {"bad", "bad pixels (|error| > 1/2), %",
                               &DisparityScores::bad_0_5_percent};

/// The method, and its iterations where there are several.
std::string curve_name(const FigureSettings& settings, const std::string& method, int iterations) {
  return settings.iterations.size() > 1 && compared_method(method).is_iterative
             ? fmt::format("{}, n = {}", method, iterations)
             : method;
}

LinePlot noise_plot(const FigureSettings& settings, const std::string& pair,
                    const ErrorMeasure& measure, const std::vector<ComparisonRun>& runs) {
  LinePlot plot{.title = pair,
                .x_axis = {.title = "standard deviation of noise, grey levels",
                           .scale = AxisScale::kCategories},
                .y_axis = {.title = std::string(measure.title)},
                .y_from_zero = true,
                .series = {}};
  for (const double sigma : settings.noise_sigmas) {
    plot.x_axis.categories.push_back(noise_label(sigma));
  }
  for (const std::string& method : settings.methods) {
    const bool is_iterative = compared_method(method).is_iterative;
    for (const int iterations : is_iterative ? settings.iterations : std::vector{0}) {
      PlotSeries series{curve_name(settings, method, iterations), {}, {}};
      for (const ComparisonRun& run : runs) {
        if (run.pair == pair && run.method == method && run.iterations == iterations) {
          series.x.push_back(static_cast<double>(series.x.size()));
          series.y.push_back(run.scores.*measure.value);
        }
      }
      plot.series.push_back(std::move(series));
    }
  }
  return plot;
}

/// In how many pairs `method` has the smallest error of all methods at noise up to `max_sigma`.
std::string count_wins(const FigureSettings& settings, const std::string& method, double max_sigma,
                       const ErrorMeasure& measure, const std::vector<ComparisonRun>& runs) {
  int wins = 0;
  int cases = 0;
  for (const ComparisonRun& run : runs) {
    if (run.method == method && run.noise_sigma <= max_sigma) {
      ++cases;
      wins += std::ranges::all_of(runs, [&](const ComparisonRun& other) {
        return other.pair != run.pair || other.noise_sigma != run.noise_sigma ||
               run.scores.*measure.value <= other.scores.*measure.value;
      });
    }
  }
  return fmt::format(
      "{} of {} (pairs x noise levels up to {})", wins, cases,
      max_sigma > settings.noise_sigmas.back() ? settings.noise_sigmas.back() : max_sigma);
}

/// Bad points of a method at noise up to 1: "ramp-square 0.4 %, …", the largest of each pair.
std::string small_noise_bad(const FigureSettings& settings, const std::string& method,
                            const std::vector<ComparisonRun>& runs) {
  constexpr double kSmallNoise = 1;
  std::vector<std::string> pairs;
  for (const std::string& pair : settings.pairs) {
    double largest = 0;
    for (const ComparisonRun& run : runs) {
      if (run.pair == pair && run.method == method && run.noise_sigma <= kSmallNoise) {
        largest = std::max(largest, run.scores.bad_0_5_percent);
      }
    }
    pairs.push_back(fmt::format("{} {:.2f} %", pair, largest));
  }
  return fmt::format("{}", fmt::join(pairs, ", "));
}

FigureContent make_noise_figure(const FigureRun& run, const ErrorMeasure& measure) {
  const FigureSettings& settings = run.settings;
  const auto runs = runs_of(run);
  FigureContent content;
  if (runs.empty()) {
    return content;
  }
  const auto draw = [&](const ErrorMeasure& shown) {
    std::vector<LinePlot> plots;
    for (const std::string& pair : settings.pairs) {
      plots.push_back(noise_plot(settings, pair, shown, runs));
    }
    content.pictures.push_back(
        {std::string(shown.name),
         draw_line_plots("Disparity error against noise", plots, kChartColumns)});
  };
  draw(measure);
  content.tables.push_back(table_of(runs));
  const std::string best = "bayes";
  if (std::ranges::find(settings.methods, best) != settings.methods.end()) {
    constexpr double kAll = 255;
    content.comparisons = {
        {"the probabilistic model has the smallest error", "clearly beats the three other methods",
         fmt::format("{}; up to noise 2: {}", count_wins(settings, best, kAll, measure, runs),
                     count_wins(settings, best, 2, measure, runs))}};
    if (&measure == &kBad) {
      content.comparisons.push_back({"bad points of the probabilistic model at noise up to 1",
                                     "0 % on three of five pairs",
                                     small_noise_bad(settings, best, runs)});
    }
  }
  // The third statistic of 6.6 has no figure of its own.
  if (&measure == &kRms) {
    draw(kMeanAbsolute);
  }
  return content;
}

LinePlot iteration_plot(const FigureSettings& settings, const std::string& pair, double noise,
                        const ErrorMeasure& measure, const std::vector<ComparisonRun>& runs) {
  LinePlot plot{.title = fmt::format("{}, noise {}", pair, noise_label(noise)),
                .x_axis = {.title = "iterations", .scale = AxisScale::kLogarithmic},
                .y_axis = {.title = std::string(measure.title)},
                .y_from_zero = true,
                .series = {}};
  for (const std::string& method : settings.methods) {
    PlotSeries series{method, {}, {}};
    for (const ComparisonRun& run : runs) {
      if (run.pair != pair || run.noise_sigma != noise || run.method != method) {
        continue;
      }
      const bool is_iterative = compared_method(method).is_iterative;
      for (const int n : is_iterative ? std::vector{run.iterations} : settings.iterations) {
        series.x.push_back(n);
        series.y.push_back(run.scores.*measure.value);
      }
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// One row per iterative method, a column per number of iterations, then the other methods, all
/// with one scale.
Drawing maps_by_iterations(const FigureSettings& settings, const std::string& pair, double noise,
                           const std::vector<ComparisonRun>& runs) {
  constexpr double kMapSide = 150;
  std::vector<const ComparisonRun*> shown;
  PreviewRange range = choose_preview_range(runs.front().map.view());
  for (const ComparisonRun& run : runs) {
    if (run.pair == pair && run.noise_sigma == noise) {
      const PreviewRange own = choose_preview_range(run.map.view());
      range = shown.empty() ? own
                            : PreviewRange{std::min(range.min_px, own.min_px),
                                           std::max(range.max_px, own.max_px)};
      shown.push_back(&run);
    }
  }
  const auto is_iterative = [](const ComparisonRun* run) {
    return compared_method(run->method).is_iterative;
  };
  std::stable_partition(shown.begin(), shown.end(), is_iterative);
  std::vector<SheetPicture> pictures;
  for (const ComparisonRun* run : shown) {
    pictures.push_back(
        {is_iterative(run) ? fmt::format("{}, n = {}", run->method, run->iterations) : run->method,
         grey_picture(run->map.view(), range.min_px, range.max_px)});
  }
  return draw_picture_sheet(
      fmt::format("Disparities of {} by iterations, noise {}", pair, noise_label(noise)), pictures,
      static_cast<int>(settings.iterations.size()), kMapSide);
}

/// Share of pixels that differ between the last two numbers of iterations.
std::string last_change(const std::string& method, const std::vector<ComparisonRun>& runs) {
  std::string text;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const bool is_last = i + 1 == runs.size() || !differ_in_iterations(runs[i], runs[i + 1]);
    if (runs[i].method == method && is_last && differ_in_iterations(runs[i - 1], runs[i])) {
      text += fmt::format("{}{:.1f} %", text.empty() ? "" : ", ",
                          percent_where(runs[i].map, [&](int x, int y, float value) {
                            return value != runs[i - 1].map.at(x, y);
                          }));
    }
  }
  return text;
}

FigureContent make_iterations_figure(const FigureRun& run) {
  const FigureSettings& settings = run.settings;
  const auto runs = runs_of(run);
  FigureContent content;
  if (runs.empty()) {
    return content;
  }
  std::vector<LinePlot> plots;
  for (const std::string& pair : settings.pairs) {
    for (const double chosen_noise : settings.noise_sigmas) {
      const double noise = noise_in_force(chosen_noise, pair);
      const bool only_one = settings.pairs.size() * settings.noise_sigmas.size() == 1;
      content.pictures.push_back({only_one ? "maps" : fmt::format("maps-{}-noise-{}", pair, noise),
                                  maps_by_iterations(settings, pair, noise, runs)});
      for (const ErrorMeasure& measure : {kMeanAbsolute, kRms, kBad}) {
        plots.push_back(iteration_plot(settings, pair, noise, measure, runs));
      }
    }
  }
  content.pictures.push_back(
      {"errors", draw_line_plots("Disparity error against iterations", plots, kChartColumns)});
  content.tables.push_back(table_of(runs));
  if (const std::size_t steps = settings.iterations.size(); steps > 1) {
    for (const std::string& method : settings.methods) {
      if (!compared_method(method).is_iterative) {
        continue;
      }
      content.comparisons.push_back(
          {fmt::format("{}: pixels that change from n = {} to {}", method,
                       settings.iterations[steps - 2], settings.iterations[steps - 1]),
           method == "diffusion" ? "keeps blurring" : "converges quickly",
           last_change(method, runs)});
    }
  }
  return content;
}

const FigureSettings kNoiseDefaults = {
    .size_px = 100,
    .iterations = {10},
    .noise_sigmas = {0, 0.25, 0.5, 1, 2, 4, 8, 16},
    .methods = {"ssd", "membrane", "local-stopping-margin", "bayes"},
    .pairs = {kBookPairNames.begin(), kBookPairNames.end()},
    .seed = 1};

}  // namespace

std::vector<BookFigure> comparison_figures() {
  return {
      {.key = "6.10",
       .section = "6.4",
       .title = "Disparities of ramp by four kinds of diffusion",
       .book = "Maps after 1 to 100 iterations of regular diffusion, local stopping (winner margin "
               "and entropy) and the membrane. Noise was added to the pair; its level is not "
               "printed: 1 grey level here.",
       .defaults = {.size_px = 100,
                    .iterations = {1, 3, 10, 30, 100},
                    .noise_sigmas = {kBookNoise},
                    .methods = {"diffusion", "local-stopping-margin", "local-stopping-entropy",
                                "membrane"},
                    .pairs = {"ramp-square"},
                    .seed = 1},
       .make = make_iterations_figure},
      {.key = "6.16",
       .section = "6.6",
       .title = "RMS error of four methods against noise",
       .book = "Five charts, one for each synthetic pair: RMS error of SSD 5x5, membrane (beta = "
               "0.5), local stopping (winner margin) and the probabilistic model, 10 iterations, "
               "against the standard deviation of the noise. Occluded points are not included.",
       .defaults = kNoiseDefaults,
       .make = [](const FigureRun& run) { return make_noise_figure(run, kRms); }},
      {.key = "6.17",
       .section = "6.6",
       .title = "Bad points of four methods against noise",
       .book = "As Fig. 6.16 with the percentage of points whose error exceeds 1/2.",
       .defaults = kNoiseDefaults,
       .make = [](const FigureRun& run) { return make_noise_figure(run, kBad); }}};
}

}  // namespace vantage
