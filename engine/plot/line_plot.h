#pragma once

#include <string>
#include <vector>

#include "engine/plot/axis.h"
#include "engine/plot/drawing.h"

namespace vantage {

/// One curve: equally many x and y. Gaps where a value cannot be drawn (NaN; not positive on a
/// logarithmic axis).
struct PlotSeries {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
};

/// One chart of curves. Axes cover all values of all its curves.
struct LinePlot {
  std::string title;
  AxisOptions x_axis;
  AxisOptions y_axis;
  bool y_from_zero = false;  ///< the linear y axis includes 0
  bool markers = true;       ///< a dot at every value
  std::vector<PlotSeries> series;
};

/// Charts in a grid of `columns` ≥ 1, under one title and one legend: curves of equal name have
/// equal colours in all of them. Throws UsageError when a curve has different numbers of x and y.
/// Thread rule: pure.
Drawing draw_line_plots(const std::string& title, const std::vector<LinePlot>& plots, int columns);

}  // namespace vantage
