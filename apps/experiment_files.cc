#include "apps/experiment_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <utility>

#include "engine/io/atomic_file.h"
#include "engine/io/preview.h"
#include "engine/plot/line_plot.h"

namespace vantage::apps {
namespace {

constexpr int kPanelColumns = 3;

/// A measure of error.
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

/// Names for readers.
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

/// All maps with one colour scale: a row per algorithm, a column per number of iterations.
Drawing contact_sheet(const std::vector<ExperimentRun>& runs) {
  constexpr double kMapSide = 150;
  constexpr double kGap = 8;
  constexpr double kLabelWidth = 175;
  constexpr double kTop = 60;
  constexpr auto kColumns = kExperimentIterations.size();
  constexpr auto kRows = kIterationMethods.size();
  float min_px = runs.front().map.at(0, 0);
  float max_px = min_px;
  for (const ExperimentRun& run : runs) {
    const PreviewRange range = choose_preview_range(run.map.view());
    min_px = std::min(min_px, range.min_px);
    max_px = std::max(max_px, range.max_px);
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
        PictureShape{{x, y}, kMapSide, kMapSide, colour_preview(run.map.view(), min_px, max_px)});
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

}  // namespace vantage::apps
