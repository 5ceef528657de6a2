#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/evaluation/disparity_section.h"
#include "engine/evaluation/disparity_space.h"
#include "engine/evaluation/method_comparison.h"
#include "engine/figures/figure_families.h"
#include "engine/figures/pair_runs.h"
#include "engine/plot/line_plot.h"
#include "engine/plot/picture_sheet.h"

namespace vantage {
namespace {

DisparitySpace space_of(const FigureRun& run, const BookPair& pair, const std::string& pair_name,
                        const std::string& method, int iterations,
                        const MethodOverrides& parameters,
                        VolumeKind kind = VolumeKind::kAggregated) {
  return disparity_space(
      pair,
      compared_options(compared_method(method), book_pair_options(pair_name).pattern, iterations,
                       parameters),
      kind, run.execution);
}

/// Support, as the book shows it: dark where it is strong. Energies support
/// where they are small.
float darkness_of(const DisparitySpace& space, float value) {
  return space.shape().content == VolumeContent::kProbabilities ? -value : value;
}

/// The values of a picture with `columns` and `rows`, from black to white.
Image<std::uint8_t> support_picture(const DisparitySpace& space, int columns, int rows,
                                    const std::function<float(int column, int row)>& value) {
  Image<float> values(columns, rows);
  float min = std::numeric_limits<float>::infinity();
  float max = -min;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const float here = darkness_of(space, value(column, row));
      values.at(column, row) = here;
      if (std::isfinite(here)) {
        min = std::min(min, here);
        max = std::max(max, here);
      }
    }
  }
  return grey_picture(values.view(), min, max > min ? max : min + 1, {200, 210, 230});
}

/// Every layer of equal disparity, then the section along the middle row.
void add_sections(const DisparitySpace& space, const std::string& name,
                  std::vector<SheetPicture>& layers, std::vector<SheetPicture>& sections) {
  const VolumeShape& shape = space.shape();
  for (int d = shape.disparities.min; d <= shape.disparities.max; ++d) {
    layers.push_back({fmt::format("{}, d = {}", name, d),
                      support_picture(space, shape.width_px, shape.height_px,
                                      [&space, d](int x, int y) { return space.at(x, y, d); })});
  }
  DisparitySection section{.disparities = shape.disparities,
                           .content = shape.content,
                           .values = Image<float>(shape.width_px, shape.disparities.count())};
  for (int x = 0; x < shape.width_px; ++x) {
    for (int d = shape.disparities.min; d <= shape.disparities.max; ++d) {
      section.values.at(x, d - shape.disparities.min) = space.at(x, shape.height_px / 2, d);
    }
  }
  const float smallest = section_quantile(section, 0);
  const float largest = section_quantile(section, 1);
  const bool small_is_likely = shape.content == VolumeContent::kEnergies;
  sections.push_back({name, section_picture(section, small_is_likely ? smallest : largest,
                                            small_is_likely ? largest : smallest)});
}

/// Mean value at the true disparity and at all other candidates, over visible
/// pixels.
std::pair<double, double> mean_values(const DisparitySpace& space, const BookPair& pair) {
  std::pair<double, double> sums;
  std::pair<double, double> counts;
  const DisparityRange range = space.shape().disparities;
  for (int y = 0; y < space.shape().height_px; ++y) {
    for (int x = 0; x < space.shape().width_px; ++x) {
      for (int d = range.min; d <= range.max && pair.left_occluded.at(x, y) == 0; ++d) {
        const double value = space.at(x, y, d);
        if (!std::isfinite(value)) {
          continue;
        }
        const bool is_true = static_cast<float>(d) == pair.left_disparity.at(x, y);
        (is_true ? sums.first : sums.second) += value;
        (is_true ? counts.first : counts.second) += 1;
      }
    }
  }
  return {sums.first / counts.first, sums.second / counts.second};
}

FigureContent make_sections(const FigureRun& run) {
  FigureContent content;
  FigureTable table{"",
                    {"pair", "method", "iterations", "noise_sigma", "mean_at_true_disparity",
                     "mean_at_other_candidates"}};
  for (const std::string& name : run.settings.pairs) {
    std::vector<SheetPicture> layers;
    std::vector<SheetPicture> sections;
    int candidates = 1;
    for (const double chosen_noise : run.settings.noise_sigmas) {
      const double noise = noise_in_force(chosen_noise, name);
      const BookPair pair = pair_of(run.settings, name, noise);
      candidates = pair.search.count();
      for (const std::string& method : run.settings.methods) {
        const bool is_iterative = compared_method(method).is_iterative;
        for (const int iterations : is_iterative ? run.settings.iterations : std::vector{0}) {
          const DisparitySpace space =
              space_of(run, pair, name, method, iterations, run.settings.parameters);
          std::string title = method;
          if (is_iterative) {
            title += iterations == 0 ? ": E0" : fmt::format(": n = {}", iterations);
          }
          if (noise > 0) {
            title += fmt::format(", noise {}", noise_label(noise));
          }
          add_sections(space, title, layers, sections);
          const auto [at_truth, elsewhere] = mean_values(space, pair);
          table.add(name, method, iterations_field(method, iterations), noise,
                    fmt::format("{:.6g}", at_truth), fmt::format("{:.6g}", elsewhere));
        }
      }
    }
    const std::string ending = run.settings.pairs.size() > 1 ? "-" + name : "";
    content.pictures.push_back(
        {"layers" + ending,
         draw_picture_sheet(
             fmt::format("Layers of the disparity space of {} (dark: strong support)", name),
             layers, candidates, 100)});
    content.pictures.push_back(
        {"row" + ending, draw_picture_sheet(fmt::format("Disparity space of {} along the "
                                                        "middle row (disparity upwards)",
                                                        name),
                                            sections, 1, 500)});
  }
  content.tables.push_back(std::move(table));
  return content;
}

/// Where Fig. 6.6 looks: at the edge of the square, and in its corner.
struct SupportPoint {
  const char* name;
  int x;
  int y;
};

FigureContent make_support_of_points(const FigureRun& run) {
  const std::string& name = run.settings.pairs.front();
  const int size = run.settings.size_px.value();
  const BookPair pair = pair_of(run.settings, name, kBookNoise);
  const int begin = static_cast<int>(std::lround(0.3 * size));  // of the square, as book_pairs
  const std::vector<SupportPoint> points = {{"a", begin, size / 2}, {"b", begin, begin}};
  MethodOverrides parameters = run.settings.parameters;
  parameters.window_px = parameters.window_px.value_or(7);
  const DisparitySpace space = space_of(run, pair, name, "ssd", 0, parameters);
  const BookPairOptions options = book_pair_options(name);
  const int front = options.front_disparity_or_default();
  const int back = options.background_disparity_px;

  FigureContent content;
  FigureTable table{"", {"point", "x_px", "y_px", "disparity_px", "mean_squared_difference"}};
  LinePlot plot{.title = fmt::format("{}, windows of {} pixels", name, *parameters.window_px),
                .x_axis = {.title = "disparity, pixels"},
                .y_axis = {.title = "mean squared difference in the window"},
                .y_from_zero = true,
                .series = {}};
  for (const SupportPoint& point : points) {
    PlotSeries series{fmt::format("point {} ({}, {})", point.name, point.x, point.y), {}, {}};
    for (int d = pair.search.min; d <= pair.search.max; ++d) {
      const double value = space.at(point.x, point.y, d);
      series.x.push_back(d);
      series.y.push_back(value);
      table.add(point.name, point.x, point.y, d, fmt::format("{:.6g}", value));
    }
    plot.series.push_back(std::move(series));
    const int reach = *parameters.window_px / 2;
    int inside = 0;
    int all = 0;
    for (int y = std::max(0, point.y - reach); y <= std::min(size - 1, point.y + reach); ++y) {
      for (int x = std::max(0, point.x - reach); x <= std::min(size - 1, point.x + reach); ++x) {
        inside += pair.left_disparity.at(x, y) == static_cast<float>(front) ? 1 : 0;
        ++all;
      }
    }
    const bool finds_front = space.at(point.x, point.y, front) < space.at(point.x, point.y, back);
    content.comparisons.push_back(
        {fmt::format("point {}: support of the foreground", point.name),
         point.name == points.front().name ? "slightly more from inside: found at d_f"
                                           : "almost 3/4 of the region is background: found at d_b",
         fmt::format("{:.0f} % of the window inside; the smaller cost is at d_{}",
                     100.0 * inside / all, finds_front ? "f" : "b")});
  }
  std::vector<SheetPicture> layers;
  for (const int d : {back, front}) {
    layers.push_back({fmt::format("d = {} ({})", d, d == back ? "background" : "foreground"),
                      support_picture(space, size, size,
                                      [&space, d](int x, int y) { return space.at(x, y, d); })});
  }
  content.pictures.push_back(
      {"layers", draw_picture_sheet("Support in windows (dark: strong)", layers, 2, 300)});
  content.pictures.push_back({"points", draw_line_plots("Support of two points", {plot}, 1)});
  content.tables.push_back(std::move(table));
  return content;
}

FigureContent make_four_steps(const FigureRun& run) {
  const std::string& name = run.settings.pairs.front();
  const int size = run.settings.size_px.value();
  const int iterations = std::max(1, run.settings.iterations.front());
  const BookPair pair = pair_of(run.settings, name, run.settings.noise_sigmas.front());
  const auto bayes_space = [&](int count, VolumeKind kind) {
    return space_of(run, pair, name, "bayes", count, run.settings.parameters, kind);
  };
  const DisparitySpace costs = bayes_space(0, VolumeKind::kCosts);
  const DisparitySpace before = bayes_space(iterations - 1, VolumeKind::kAggregated);
  const DisparitySpace after = bayes_space(iterations, VolumeKind::kAggregated);
  const MethodParameters parameters =
      compared_options(compared_method("bayes"), book_pair_options(name).pattern, iterations,
                       run.settings.parameters)
          .resolved();
  // Just inside the square, where its support and that of the background
  // compete.
  const int x = std::max(static_cast<int>(std::lround(0.3 * size)) + 1, pair.search.max + 2);
  const int y = size / 2;
  const BayesSteps steps = bayes_steps(costs, before, parameters, x, y);

  FigureContent content;
  FigureTable table{"",
                    {"disparity_px", "p_before", "p_smoothed", "E_smoothed", "E_diffused",
                     "p_after", "p_after_by_the_engine"}};
  PlotSeries before_series{"p before", {}, {}};
  PlotSeries smoothed_series{"pS, smoothed along d", {}, {}};
  PlotSeries after_series{"p after", {}, {}};
  PlotSeries smoothed_energy_series{"ES = -log pS", {}, {}};
  PlotSeries energy_series{"E, diffused", {}, {}};
  double difference = 0;
  for (int d = pair.search.min; d <= pair.search.max; ++d) {
    const auto i = static_cast<std::size_t>(d - pair.search.min);
    const double by_engine = after.at(x, y, d);
    difference = std::max(difference, std::abs(steps.probability[i] - by_engine));
    const auto add = [d](PlotSeries& series, double value) {
      series.x.push_back(d);
      series.y.push_back(value);
    };
    add(before_series, before.at(x, y, d));
    add(smoothed_series, steps.smoothed[i]);
    add(after_series, steps.probability[i]);
    add(smoothed_energy_series, steps.smoothed_energy[i]);
    add(energy_series, steps.energy[i]);
    table.add(
        d, fmt::format("{:.6g}", before.at(x, y, d)), fmt::format("{:.6g}", steps.smoothed[i]),
        fmt::format("{:.6g}", steps.smoothed_energy[i]), fmt::format("{:.6g}", steps.energy[i]),
        fmt::format("{:.6g}", steps.probability[i]), fmt::format("{:.6g}", by_engine));
  }
  const auto plot_of = [](const char* title, std::vector<PlotSeries> series) {
    return LinePlot{.title = title,
                    .x_axis = {.title = "disparity, pixels"},
                    .y_axis = {.title = title},
                    .y_from_zero = true,
                    .series = std::move(series)};
  };
  content.pictures.push_back(
      {"",
       draw_line_plots(fmt::format("Iteration {} at pixel ({}, {}) of {}", iterations, x, y, name),
                       {plot_of("probability", {before_series, smoothed_series, after_series}),
                        plot_of("energy, nats", {smoothed_energy_series, energy_series})},
                       2)});
  content.tables.push_back(std::move(table));
  content.comparisons = {{"the four steps, computed from the equations, and the engine", "",
                          fmt::format("largest difference of p: {:.2g}", difference)}};
  return content;
}

}  // namespace

std::vector<BookFigure> disparity_space_figures() {
  MethodOverrides window;
  window.window_px = 7;
  return {{.key = "6.6",
           .section = "6.2",
           .title = "Support for two disparities near a boundary",
           .book = "Windows around a point a beside the square's edge and a "
                   "point b in its corner, in the layers of the background's and of the "
                   "foreground's disparity: corners get rounded, straight edges do not move.",
           .defaults = {.size_px = 100, .pairs = {"rds-square"}, .seed = 1, .parameters = window},
           .method = "ssd",
           .make = make_support_of_points},
          {.key = "6.7",
           .section = "6.3.1",
           .title = "Sections through the disparity space",
           .book = "Disparity space of rds by the membrane model: E0, after "
                   "one and after ten iterations. Dark is strong support.",
           .defaults = {.size_px = 100,
                        .iterations = {0, 1, 10},
                        .noise_sigmas = {kBookNoise},
                        .methods = {"membrane"},
                        .pairs = {"rds-square"},
                        .seed = 1},
           .make = make_sections},
          {.key = "6.12",
           .section = "6.5.3",
           .title = "The four steps of Bayesian diffusion",
           .book = "Probabilities are smoothed along each column, converted to "
                   "energies, diffused among neighbours and converted back. A drawing; here with "
                   "the values of one column.",
           .defaults = {.size_px = 100,
                        .iterations = {1},
                        .noise_sigmas = {kBookNoise},
                        .pairs = {"rds-square"},
                        .seed = 1},
           .method = "bayes",
           .make = make_four_steps}};
}

}  // namespace vantage
