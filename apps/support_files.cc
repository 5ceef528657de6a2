#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "apps/experiment_files.h"
#include "engine/evaluation/membrane_support.h"
#include "engine/io/atomic_file.h"
#include "engine/plot/heat_map.h"
#include "engine/plot/line_plot.h"

namespace vantage::apps {
namespace {

constexpr double kFigureBeta = 0.7;  // of Fig. 6.9
constexpr std::array<double, 4> kBetas = {0.3, 0.5, kFigureBeta, 1};
constexpr std::array<int, 4> kIterations = {1, 10, 30, 100};
constexpr double kLambda = 0.15;
constexpr int kRadius = 40;
constexpr int kShownRadius = 10;

/// The support for one β: after iterations, and in the limit.
struct Support {
  explicit Support(double beta_in_force)
      : beta(beta_in_force), limit(membrane_support(beta, kRadius)) {
    for (const int iterations : kIterations) {
      responses.push_back(membrane_impulse_response(beta, kLambda, iterations, kRadius));
    }
  }

  double beta;
  SupportFunction limit;
  std::vector<SupportFunction> responses;  ///< by kIterations
};

/// One quadrant; the others are equal.
std::string csv(const std::vector<Support>& supports) {
  std::string table = "beta,dx,dy,inverse_fourier";
  for (const int iterations : kIterations) {
    table += fmt::format(",iterations_{}", iterations);
  }
  table += '\n';
  for (const Support& support : supports) {
    for (int dy = 0; dy <= kShownRadius; ++dy) {
      for (int dx = 0; dx <= kShownRadius; ++dx) {
        table += fmt::format("{},{},{},{:.12g}", support.beta, dx, dy, support.limit.at(dx, dy));
        for (const SupportFunction& response : support.responses) {
          table += fmt::format(",{:.12g}", response.at(dx, dy));
        }
        table += '\n';
      }
    }
  }
  return table;
}

PlotSeries section(std::string name, const SupportFunction& function) {
  PlotSeries series{std::move(name), {}, {}};
  for (int dx = -kShownRadius; dx <= kShownRadius; ++dx) {
    series.x.push_back(dx);
    series.y.push_back(function.at(dx, 0));
  }
  return series;
}

LinePlot sections(const Support& support) {
  LinePlot plot{.title = fmt::format("beta = {}", support.beta),
                .x_axis = {.title = "dx, pixels (dy = 0)"},
                .y_axis = {.title = "weight", .scale = AxisScale::kLogarithmic},
                .series = {}};
  for (std::size_t i = 0; i < kIterations.size(); ++i) {
    plot.series.push_back(section(fmt::format("n = {}", kIterations[i]), support.responses[i]));
  }
  plot.series.push_back(section("inverse Fourier transform of (6.12)", support.limit));
  return plot;
}

HeatMap surface(const SupportFunction& function) {
  HeatMap map{.title = "inverse Fourier transform of (6.12)",
              .x_title = "dx, pixels",
              .y_title = "dy, pixels",
              .x_first = -kShownRadius,
              .y_first = -kShownRadius,
              .values = Image<float>(2 * kShownRadius + 1, 2 * kShownRadius + 1)};
  for (int dy = -kShownRadius; dy <= kShownRadius; ++dy) {
    for (int dx = -kShownRadius; dx <= kShownRadius; ++dx) {
      map.values.at(dx + kShownRadius, dy + kShownRadius) = static_cast<float>(function.at(dx, dy));
    }
  }
  return map;
}

}  // namespace

double write_support_files(const std::filesystem::path& folder) {
  std::vector<Support> supports;
  std::vector<LinePlot> plots;
  std::vector<HeatMap> maps;
  double difference = 0;
  for (const double beta : kBetas) {
    const Support& support = supports.emplace_back(beta);
    plots.push_back(sections(support));
    difference = std::max(difference, largest_difference(support.limit, support.responses.back()));
    if (beta == kFigureBeta) {
      maps.push_back(surface(support.limit));
    }
  }
  constexpr int kColumns = 2;
  write_text_file(folder / "support.csv", csv(supports));
  write_drawing(folder / "support.svg",
                draw_line_plots(
                    fmt::format("Support of the membrane after n iterations, lambda = {}", kLambda),
                    plots, kColumns));
  write_drawing(
      folder / "support-shape.svg",
      draw_heat_maps(fmt::format("Support of the membrane, beta = {}", kFigureBeta), maps, 1));
  return difference;
}

}  // namespace vantage::apps
