#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "engine/figures/figure_families.h"
#include "engine/matching/options/method_names.h"
#include "engine/matching/parameters/prior_penalty.h"
#include "engine/plot/heat_map.h"
#include "engine/plot/line_plot.h"

namespace vantage {
namespace {

constexpr double kStepsPerUnit = 20;

/// (5.3) with α, the second vector being (1, 0).
double evidence_with_unit(double x, double y, double alpha) {
  return (std::hypot(x, y) + 1) / 2 - alpha * std::hypot(x - 1, y);
}

FigureContent make_evidence_levels(const FigureRun& run) {
  constexpr int kReach = 40;  // steps: two unit lengths
  const double alpha = run.settings.parameters.alpha.value_or(1);
  FigureContent content;
  FigureTable table{"", {"x", "y", "evidence"}};
  HeatMap map{.title = fmt::format("e for (x, y) and (1, 0), alpha = {}", alpha),
              .x_title = "x, twentieths of the unit vector",
              .y_title = "-y, twentieths",
              .x_first = -kReach,
              .y_first = -kReach,
              .values = Image<float>(2 * kReach + 1, 2 * kReach + 1)};
  for (int row = -kReach; row <= kReach; ++row) {
    for (int column = -kReach; column <= kReach; ++column) {
      const double x = column / kStepsPerUnit;
      const double y = -row / kStepsPerUnit;
      const double evidence = evidence_with_unit(x, y, alpha);
      map.values.at(column + kReach, row + kReach) = static_cast<float>(evidence);
      table.add(x, y, fmt::format("{:.6f}", evidence));
    }
  }
  std::vector<HeatMap> maps;
  maps.push_back(std::move(map));
  content.pictures.push_back({"", draw_heat_maps("Evidence for a match with (1, 0)", maps, 1)});
  content.tables.push_back(std::move(table));
  const double sixty_degrees = evidence_with_unit(0.5, std::sqrt(0.75), alpha);
  content.comparisons = {
      {"two equal vectors of length m", "m",
       fmt::format("{:.4f} m", evidence_with_unit(1, 0, alpha))},
      {"opposite vectors", "-m", fmt::format("{:.4f} m", evidence_with_unit(-1, 0, alpha))},
      {"right angle", "(1 - sqrt 2) m = -0.4142 m",
       fmt::format("{:.4f} m", evidence_with_unit(0, 1, alpha))},
      {"unit vector at 60 degrees", "0", fmt::format("{:.4f}", sixty_degrees)}};
  return content;
}

FigureContent make_prior(const FigureRun& run) {
  constexpr int kReach = 100;  // steps
  MethodParameters parameters;
  parameters.epsilon_prior = run.settings.parameters.epsilon_prior.value_or(0.01);
  parameters.sigma_prior = run.settings.parameters.sigma_prior.value_or(1);
  const double epsilon = parameters.epsilon_prior;
  FigureContent content;
  FigureTable table{"", {"x"}};
  LinePlot plot{.title = fmt::format("epsilon = {}, sigma = {}", epsilon, parameters.sigma_prior),
                .x_axis = {.title = "difference of neighbouring disparities, pixels"},
                .y_axis = {.title = "penalty"},
                .y_from_zero = true,
                .markers = false,
                .series = {}};
  for (const auto& [name, prior] : names_of(Prior{})) {
    table.columns.emplace_back(name);
    plot.series.push_back({std::string(name), {}, {}});
  }
  for (int step = -kReach; step <= kReach; ++step) {
    const double x = step / kStepsPerUnit;
    table.add(x);
    for (std::size_t k = 0; k < names_of(Prior{}).size(); ++k) {
      parameters.prior = names_of(Prior{})[k].second;
      const double value = prior_penalty(parameters, x);
      plot.series[k].x.push_back(x);
      plot.series[k].y.push_back(value);
      table.rows.back().push_back(fmt::format("{:.6f}", value));
    }
  }
  const auto penalty = [&](double x) {
    parameters.prior = Prior::kContaminatedGaussian;
    return prior_penalty(parameters, x);
  };
  content.pictures.push_back({"", draw_line_plots("Penalties of the priors", {plot}, 1)});
  content.tables.push_back(std::move(table));
  content.comparisons = {
      {"limit for large differences", "-log epsilon",
       fmt::format("{:.4f}; at 5 pixels {:.4f}", -std::log(epsilon), penalty(5))}};
  return content;
}

}  // namespace

std::vector<BookFigure> formula_figures() {
  return {
      {.key = "5.2",
       .section = "5.3.1",
       .title = "The evidence measure",
       .book = "Contour lines of the evidence for a match of any vector with (1, 0); Fig. 5.1 "
               "has values for single pairs of vectors.",
       .defaults = {},
       .method = "gradient",
       .parameters = {"alpha"},
       .make = make_evidence_levels},
      {.key = "6.11",
       .section = "6.5.1",
       .title = "Shape of the robust penalty",
       .book = "The penalty (6.19) for epsilon = 0.01 and sigma = 1; 6.5.1 names a quadratic and a "
               "unit impulse beside it.",
       .defaults = {},
       .method = "bayes",
       .parameters = {"epsilon-prior", "sigma-prior"},
       .make = make_prior}};
}

}  // namespace vantage
