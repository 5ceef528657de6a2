#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "engine/evaluation/membrane_support.h"
#include "engine/figures/figure_families.h"
#include "engine/plot/heat_map.h"
#include "engine/plot/line_plot.h"

namespace vantage {
namespace {

constexpr double kFigureBeta = 0.7;
constexpr std::array<double, 4> kBetas = {0.3, 0.5, kFigureBeta, 1};
constexpr double kLambda = 0.15;
constexpr int kRadius = 40;
constexpr int kShownRadius = 10;

/// The support for one β: after iterations, and in the limit.
struct MembraneSupport {
  MembraneSupport(double beta_in_force, const std::vector<int>& iterations)
      : beta(beta_in_force), limit(membrane_support(beta, kRadius)) {
    for (const int count : iterations) {
      responses.push_back(membrane_impulse_response(beta, kLambda, count, kRadius));
    }
  }

  double beta;
  SupportFunction limit;
  std::vector<SupportFunction> responses;  ///< by iterations
};

/// One quadrant; the others are equal.
FigureTable table_of(const std::vector<MembraneSupport>& supports,
                     const std::vector<int>& iterations) {
  FigureTable table{"", {"beta", "dx", "dy", "inverse_fourier"}};
  for (const int count : iterations) {
    table.columns.push_back(fmt::format("iterations_{}", count));
  }
  for (const MembraneSupport& support : supports) {
    for (int dy = 0; dy <= kShownRadius; ++dy) {
      for (int dx = 0; dx <= kShownRadius; ++dx) {
        table.add(support.beta, dx, dy, fmt::format("{:.12g}", support.limit.at(dx, dy)));
        for (const SupportFunction& response : support.responses) {
          table.rows.back().push_back(fmt::format("{:.12g}", response.at(dx, dy)));
        }
      }
    }
  }
  return table;
}

PlotSeries section_of(std::string name, const SupportFunction& function) {
  PlotSeries series{std::move(name), {}, {}};
  for (int dx = -kShownRadius; dx <= kShownRadius; ++dx) {
    series.x.push_back(dx);
    series.y.push_back(function.at(dx, 0));
  }
  return series;
}

LinePlot sections_of(const MembraneSupport& support, const std::vector<int>& iterations) {
  LinePlot plot{.title = fmt::format("beta = {}", support.beta),
                .x_axis = {.title = "dx, pixels (dy = 0)"},
                .y_axis = {.title = "weight", .scale = AxisScale::kLogarithmic},
                .series = {}};
  for (std::size_t i = 0; i < iterations.size(); ++i) {
    plot.series.push_back(section_of(fmt::format("n = {}", iterations[i]), support.responses[i]));
  }
  plot.series.push_back(section_of("inverse Fourier transform of (6.12)", support.limit));
  return plot;
}

Image<float> values_of(const SupportFunction& function) {
  Image<float> values(2 * kShownRadius + 1, 2 * kShownRadius + 1);
  for (int dy = -kShownRadius; dy <= kShownRadius; ++dy) {
    for (int dx = -kShownRadius; dx <= kShownRadius; ++dx) {
      values.at(dx + kShownRadius, dy + kShownRadius) = static_cast<float>(function.at(dx, dy));
    }
  }
  return values;
}

FigureContent make_support(const FigureRun& run) {
  const std::vector<int>& iterations = run.settings.iterations;
  std::vector<double> betas(kBetas.begin(), kBetas.end());
  const double shown_beta = run.settings.parameters.beta.value_or(kFigureBeta);
  if (std::ranges::find(betas, shown_beta) == betas.end()) {
    betas.push_back(shown_beta);
  }
  std::vector<MembraneSupport> supports;
  std::vector<LinePlot> plots;
  double difference = 0;
  for (const double beta : betas) {
    const MembraneSupport& support = supports.emplace_back(beta, iterations);
    plots.push_back(sections_of(support, iterations));
    difference = std::max(difference, largest_difference(support.limit, support.responses.back()));
  }
  const auto shown =
      std::ranges::find(supports, shown_beta, [](const auto& support) { return support.beta; });

  FigureContent content;
  const std::string shape_title = fmt::format("Support of the membrane, beta = {}", shown_beta);
  std::vector<HeatMap> maps;
  maps.push_back({.title = "inverse Fourier transform of (6.12)",
                  .x_title = "dx, pixels",
                  .y_title = "dy, pixels",
                  .x_first = -kShownRadius,
                  .y_first = -kShownRadius,
                  .values = values_of(shown->limit)});
  content.pictures.push_back({"levels", draw_heat_maps(shape_title, maps, 1)});
  constexpr int kColumns = 2;
  content.pictures.push_back(
      {"sections",
       draw_line_plots(
           fmt::format("Support of the membrane after n iterations, lambda = {}", kLambda), plots,
           kColumns)});
  content.tables.push_back(table_of(supports, iterations));
  const SupportFunction& limit = shown->limit;
  content.comparisons = {
      {"shape", "cone-shaped, not rounded as a Gaussian",
       fmt::format("weights at 0, 1, 2, 3 pixels: {:.4f}, {:.4f}, {:.4f}, {:.4f}", limit.at(0, 0),
                   limit.at(1, 0), limit.at(2, 0), limit.at(3, 0))},
      {fmt::format("iterations of (6.9) against (6.12), n = {}", iterations.back()),
       "the iterations converge to (6.12)", fmt::format("largest difference {:.2g}", difference)}};
  return content;
}

}  // namespace

std::vector<BookFigure> membrane_figures() {
  return {{.key = "6.9",
           .section = "6.3.2",
           .title = "Shape of the membrane's support function",
           .book = "A surface and contour lines of the support function for beta = 0.7.",
           .defaults = {.iterations = {1, 10, 30, 100}},
           .method = "membrane",
           .parameters = {"beta"},
           .make = make_support}};
}

}  // namespace vantage
