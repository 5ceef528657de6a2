#include "apps/experiment_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <utility>

#include "engine/evaluation/membrane_support.h"
#include "engine/io/atomic_file.h"
#include "engine/io/preview.h"
#include "engine/plot/heat_map.h"
#include "engine/plot/line_plot.h"

namespace vantage::apps {
namespace {

constexpr int kPanelColumns = 3;

/// A figure that runs are judged by.
struct Statistic {
  std::string name;   ///< in file names
  std::string title;  ///< on axes
  std::function<double(const DisparityScores&)> value;
};

const std::array<Statistic, 3>& statistics() {
  static const std::array<Statistic, 3> all = {
      Statistic{"mean-absolute", "mean |error|, pixels",
                [](const DisparityScores& scores) { return scores.average_px; }},
      Statistic{"rms", "RMS error, pixels",
                [](const DisparityScores& scores) { return scores.rms_px; }},
      Statistic{"bad", "bad pixels (|error| > 1/2), %",
                [](const DisparityScores& scores) { return scores.bad_0_5_percent; }}};
  return all;
}

std::string csv(const std::vector<ExperimentRun>& runs) {
  std::string text =
      "pair,method,iterations,noise_sigma,mean_absolute_px,rms_px,bad_percent,evaluated_pixels\n";
  for (const ExperimentRun& run : runs) {
    text += fmt::format("{},{},{},{},{:.6f},{:.6f},{:.4f},{}\n", run.pair,
                        experiment_method_name(run.method), run.iterations, run.noise_sigma,
                        run.scores.average_px, run.scores.rms_px, run.scores.bad_0_5_percent,
                        run.scores.evaluated_pixels);
  }
  return text;
}

std::vector<std::string> pairs_of(const std::vector<ExperimentRun>& runs) {
  std::vector<std::string> pairs;
  for (const ExperimentRun& run : runs) {
    if (std::ranges::find(pairs, run.pair) == pairs.end()) {
      pairs.push_back(run.pair);
    }
  }
  return pairs;
}

/// As people write them.
std::string noise_label(double sigma) {
  return sigma == 0.25 ? "1/4" : sigma == 0.5 ? "1/2" : fmt::format("{}", sigma);
}

LinePlot noise_plot(const std::string& pair, const Statistic& statistic,
                    const std::vector<ExperimentRun>& runs) {
  LinePlot plot{.title = pair,
                .x_axis = {.title = "standard deviation of noise, grey levels",
                           .scale = AxisScale::kCategories},
                .y_axis = {.title = statistic.title},
                .y_from_zero = true,
                .series = {}};
  for (const double sigma : kExperimentNoise) {
    plot.x_axis.categories.push_back(noise_label(sigma));
  }
  for (const ExperimentMethod method : kNoiseMethods) {
    PlotSeries series{std::string(experiment_method_name(method)), {}, {}};
    for (const ExperimentRun& run : runs) {
      if (run.pair == pair && run.method == method) {
        series.x.push_back(static_cast<double>(series.x.size()));
        series.y.push_back(statistic.value(run.scores));
      }
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

LinePlot iteration_plot(const Statistic& statistic, const std::vector<ExperimentRun>& runs) {
  LinePlot plot{.title = pairs_of(runs).front(),
                .x_axis = {.title = "iterations", .scale = AxisScale::kLogarithmic},
                .y_axis = {.title = statistic.title},
                .y_from_zero = true,
                .series = {}};
  for (const ExperimentMethod method : kIterationMethods) {
    PlotSeries series{std::string(experiment_method_name(method)), {}, {}};
    for (const ExperimentRun& run : runs) {
      if (run.method == method) {
        series.x.push_back(run.iterations);
        series.y.push_back(statistic.value(run.scores));
      }
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

/// All maps in the colours of one range, a row per algorithm, a column per number of iterations.
Drawing contact_sheet(const std::vector<ExperimentRun>& runs) {
  constexpr double kMapSide = 150;
  constexpr double kGap = 8;
  constexpr double kLabelWidth = 175;
  constexpr double kTop = 60;
  constexpr auto kColumns = kExperimentIterations.size();
  constexpr auto kRows = kIterationMethods.size();
  float least = runs.front().map.at(0, 0);
  float most = least;
  for (const ExperimentRun& run : runs) {
    const PreviewRange range = choose_preview_range(run.map.view());
    least = std::min(least, range.min_px);
    most = std::max(most, range.max_px);
  }
  Drawing drawing;
  drawing.width = static_cast<int>(kLabelWidth + kColumns * (kMapSide + kGap));
  drawing.height = static_cast<int>(kTop + kRows * (kMapSide + kGap));
  draw_page_title(fmt::format("Disparities of {} by iterations", runs.front().pair), drawing);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ExperimentRun& run = runs[i];
    const double x = kLabelWidth + static_cast<double>(i % kColumns) * (kMapSide + kGap);
    const double y = kTop + static_cast<double>(i / kColumns) * (kMapSide + kGap);
    if (i < kColumns) {
      drawing.shapes.emplace_back(TextShape{{x + kMapSide / 2, kTop - 8},
                                            fmt::format("{}", run.iterations),
                                            kTextSize + 1,
                                            TextShape::Anchor::kMiddle,
                                            kInk});
    }
    if (i % kColumns == 0) {
      drawing.shapes.emplace_back(TextShape{{kLabelWidth - 10, y + kMapSide / 2},
                                            std::string(experiment_method_name(run.method)),
                                            kTextSize + 1,
                                            TextShape::Anchor::kEnd,
                                            kInk});
    }
    drawing.shapes.emplace_back(
        PictureShape{{x, y}, kMapSide, kMapSide, colour_preview(run.map.view(), least, most)});
  }
  return drawing;
}

}  // namespace

void write_noise_files(const std::filesystem::path& folder,
                       const std::vector<ExperimentRun>& runs) {
  write_text_file(folder / "noise.csv", csv(runs));
  for (const Statistic& statistic : statistics()) {
    std::vector<LinePlot> plots;
    for (const std::string& pair : pairs_of(runs)) {
      plots.push_back(noise_plot(pair, statistic, runs));
    }
    const std::string title =
        fmt::format("Disparity error against noise, {} iterations", runs.front().iterations);
    write_drawing(folder / fmt::format("noise-{}.svg", statistic.name),
                  draw_line_plots(title, plots, kPanelColumns));
  }
}

void write_iteration_files(const std::filesystem::path& folder,
                           const std::vector<ExperimentRun>& runs) {
  write_text_file(folder / "iterations.csv", csv(runs));
  std::vector<LinePlot> plots;
  for (const Statistic& statistic : statistics()) {
    plots.push_back(iteration_plot(statistic, runs));
  }
  write_drawing(folder / "iterations.svg",
                draw_line_plots("Disparity error against iterations", plots, kPanelColumns));
  write_drawing(folder / "iterations-maps.png", contact_sheet(runs));
}

double write_support_files(const std::filesystem::path& folder) {
  constexpr std::array<double, 4> kBetas = {0.3, 0.5, 0.7, 1};
  constexpr double kFigureBeta = 0.7;
  constexpr std::array<int, 4> kIterations = {1, 10, 30, 100};
  constexpr double kLambda = 0.15;
  constexpr int kRadius = 40;
  constexpr int kShownRadius = 10;
  double difference = 0;
  std::string table = "beta,dx,dy,inverse_fourier";
  for (const int iterations : kIterations) {
    table += fmt::format(",iterations_{}", iterations);
  }
  table += '\n';
  std::vector<LinePlot> plots;
  for (const double beta : kBetas) {
    LinePlot plot{.title = fmt::format("beta = {}", beta),
                  .x_axis = {.title = "dx, pixels (dy = 0)"},
                  .y_axis = {.title = "weight", .scale = AxisScale::kLogarithmic},
                  .series = {}};
    const SupportFunction limit = membrane_support(beta, kRadius);
    std::vector<SupportFunction> responses;
    std::vector<std::pair<std::string, const SupportFunction*>> curves;
    for (const int iterations : kIterations) {
      responses.push_back(membrane_impulse_response(beta, kLambda, iterations, kRadius));
    }
    for (std::size_t i = 0; i < responses.size(); ++i) {
      curves.emplace_back(fmt::format("n = {}", kIterations[i]), &responses[i]);
    }
    curves.emplace_back("inverse Fourier transform of (6.12)", &limit);
    for (const auto& [name, support] : curves) {
      PlotSeries series{name, {}, {}};
      for (int dx = -kShownRadius; dx <= kShownRadius; ++dx) {
        series.x.push_back(dx);
        series.y.push_back(support->at(dx, 0));
      }
      plot.series.push_back(std::move(series));
    }
    plots.push_back(std::move(plot));
    for (int dy = 0; dy <= kShownRadius; ++dy) {
      for (int dx = 0; dx <= kShownRadius; ++dx) {
        table += fmt::format("{},{},{},{:.12g}", beta, dx, dy, limit.at(dx, dy));
        for (const SupportFunction& response : responses) {
          table += fmt::format(",{:.12g}", response.at(dx, dy));
        }
        table += '\n';
      }
    }
    difference = std::max(difference, largest_difference(limit, responses.back()));
  }
  write_text_file(folder / "support.csv", table);
  write_drawing(folder / "support.svg",
                draw_line_plots(
                    fmt::format("Support of the membrane after n iterations, lambda = {}", kLambda),
                    plots, 2));
  const SupportFunction shape = membrane_support(kFigureBeta, kShownRadius);
  HeatMap map{.title = "inverse Fourier transform of (6.12)",
              .x_title = "dx, pixels",
              .y_title = "dy, pixels",
              .x_first = -kShownRadius,
              .y_first = -kShownRadius,
              .values = Image<float>(2 * kShownRadius + 1, 2 * kShownRadius + 1)};
  for (int dy = -kShownRadius; dy <= kShownRadius; ++dy) {
    for (int dx = -kShownRadius; dx <= kShownRadius; ++dx) {
      map.values.at(dx + kShownRadius, dy + kShownRadius) = static_cast<float>(shape.at(dx, dy));
    }
  }
  std::vector<HeatMap> maps;
  maps.push_back(std::move(map));
  write_drawing(
      folder / "support-shape.svg",
      draw_heat_maps(fmt::format("Support of the membrane, beta = {}", kFigureBeta), maps, 1));
  return difference;
}

}  // namespace vantage::apps
