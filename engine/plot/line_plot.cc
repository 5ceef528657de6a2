#include "engine/plot/line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr double kChartWidth = 320;
constexpr double kChartHeight = 200;
constexpr double kLegendRowHeight = 20;
constexpr double kLegendLine = 26;
constexpr double kLinePlotMargin = 16;

// Distinguishable in print and for most colour-blind people.
constexpr std::array<Colour, 8> kColours = {
    Colour{0, 114, 178}, Colour{213, 94, 0},   Colour{0, 158, 115},   Colour{204, 121, 167},
    Colour{230, 159, 0}, Colour{86, 180, 233}, Colour{110, 110, 110}, Colour{150, 75, 30}};

struct Bounds {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
};

/// Extends `bounds` by the values that an axis can show.
void include(const std::vector<double>& values, AxisScale scale, Bounds& bounds) {
  for (const double value : values) {
    if (std::isfinite(value) && (scale != AxisScale::kLogarithmic || value > 0)) {
      bounds.min = std::min(bounds.min, value);
      bounds.max = std::max(bounds.max, value);
    }
  }
}

std::vector<std::string> names_of(const std::vector<LinePlot>& plots) {
  std::vector<std::string> names;
  for (const LinePlot& plot : plots) {
    for (const PlotSeries& series : plot.series) {
      if (std::ranges::find(names, series.name) == names.end()) {
        names.push_back(series.name);
      }
    }
  }
  return names;
}

Colour colour_of(const std::vector<std::string>& names, const std::string& name) {
  const auto index = std::ranges::find(names, name) - names.begin();
  return kColours[static_cast<std::size_t>(index) % kColours.size()];
}

/// Returns its height.
double draw_legend(const std::vector<std::string>& names, double top, double width,
                   Drawing& drawing) {
  double x = kLinePlotMargin;
  double y = top + kLegendRowHeight / 2;
  for (const std::string& name : names) {
    const double entry = kLegendLine + 6 + text_width(name, kTextSize) + 18;
    if (x > kLinePlotMargin && x + entry > width) {
      x = kLinePlotMargin;
      y += kLegendRowHeight;
    }
    const Colour colour = colour_of(names, name);
    drawing.stroke({{x, y}, {x + kLegendLine, y}}, 2, colour);
    drawing.disc({x + kLegendLine / 2, y}, 3, colour);
    drawing.text({x + kLegendLine + 6, y + 0.35 * kTextSize}, name);
    x += entry;
  }
  return y + kLegendRowHeight / 2 - top;
}

void draw_series(const PlotSeries& series, const ChartArea& area, const Axis& x_axis,
                 const Axis& y_axis, Colour colour, bool markers, Drawing& drawing) {
  std::vector<DrawingPoint> points;
  const auto finish_stroke = [&] {
    if (points.size() > 1) {
      drawing.stroke(points, 1.6, colour);
    }
    if (markers || points.size() == 1) {
      for (const DrawingPoint& point : points) {
        drawing.disc(point, 2.6, colour);
      }
    }
    points.clear();
  };
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double x = area.corner.x + x_axis.place(series.x[i]) * area.width;
    const double y = area.corner.y + (1 - y_axis.place(series.y[i])) * area.height;
    if (std::isfinite(x) && std::isfinite(y)) {
      points.push_back({x, y});
    } else {
      finish_stroke();
    }
  }
  finish_stroke();
}

void draw_plot(const LinePlot& plot, const ChartArea& area, const std::vector<std::string>& names,
               Drawing& drawing) {
  Bounds x_bounds;
  Bounds y_bounds;
  for (const PlotSeries& series : plot.series) {
    include(series.x, plot.x_axis.scale, x_bounds);
    include(series.y, plot.y_axis.scale, y_bounds);
  }
  if (plot.y_from_zero && plot.y_axis.scale == AxisScale::kLinear) {
    include({0}, plot.y_axis.scale, y_bounds);
    if (y_bounds.max == 0 && y_bounds.min == 0) {
      y_bounds.max = 1;
    }
  }
  const Axis x_axis(plot.x_axis, x_bounds.min, x_bounds.max, false);
  const Axis y_axis(plot.y_axis, y_bounds.min, y_bounds.max, true);
  draw_chart_frame(area, plot.title, x_axis, y_axis, true, drawing);
  for (const PlotSeries& series : plot.series) {
    draw_series(series, area, x_axis, y_axis, colour_of(names, series.name), plot.markers, drawing);
  }
}

}  // namespace

Drawing draw_line_plots(const std::string& title, const std::vector<LinePlot>& plots, int columns) {
  for (const LinePlot& plot : plots) {
    for (const PlotSeries& series : plot.series) {
      if (series.x.size() != series.y.size()) {
        throw UsageError(fmt::format("curve '{}' has {} x and {} y, expected equally many",
                                     series.name, series.x.size(), series.y.size()));
      }
    }
  }
  constexpr double kPanelWidth = kFrameLeft + kChartWidth + kFrameRight;
  constexpr double kPanelHeight = kFrameTop + kChartHeight + kFrameBottom;
  const int count = static_cast<int>(plots.size());
  const int used_columns = std::clamp(columns, 1, std::max(1, count));
  Drawing drawing;
  drawing.width = static_cast<int>(used_columns * kPanelWidth + kLinePlotMargin);
  draw_page_title(title, drawing);
  const std::vector<std::string> names = names_of(plots);
  const double top =
      kPageTitleHeight + draw_legend(names, kPageTitleHeight, drawing.width, drawing);
  for (int i = 0; i < count; ++i) {
    const ChartArea area = {{i % used_columns * kPanelWidth + kFrameLeft,
                             top + i / used_columns * kPanelHeight + kFrameTop},
                            kChartWidth,
                            kChartHeight};
    draw_plot(plots[static_cast<std::size_t>(i)], area, names, drawing);
  }
  const int rows = (count + used_columns - 1) / used_columns;
  drawing.height = static_cast<int>(top + rows * kPanelHeight + kLinePlotMargin);
  return drawing;
}

}  // namespace vantage
