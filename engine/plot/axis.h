#pragma once

#include <string>
#include <vector>

#include "engine/plot/drawing.h"

namespace vantage {

enum class AxisScale {
  kLinear,
  kLogarithmic,  ///< positive values only; others are not drawn
  kCategories    ///< value i is the i-th category, equally spaced
};

struct AxisOptions {
  std::string title;
  AxisScale scale = AxisScale::kLinear;
  std::vector<std::string> categories = {};  ///< for kCategories
  bool downwards = false;                    ///< from its end to its start, like the rows of an
                                             ///< image
};

/// Maps values to positions along an axis, with ticks at round values.
class Axis {
 public:
  struct Tick {
    double place = 0;  ///< 0 at the start of the axis, 1 at its end
    std::string label;
  };

  /// An axis for values from `min` to `max` (equal, reversed or not finite: some range around
  /// them). `round_ends`: it starts and ends at ticks.
  Axis(AxisOptions options, double min, double max, bool round_ends);

  [[nodiscard]] const std::string& title() const { return options_.title; }
  [[nodiscard]] const std::vector<Tick>& ticks() const { return ticks_; }
  /// 0..1 for values that the axis shows; NaN for those it cannot.
  [[nodiscard]] double place(double value) const;

 private:
  void make_linear_ticks(bool round_ends);
  void make_logarithmic_ticks(bool round_ends);

  AxisOptions options_;
  double begin_ = 0;  ///< logarithmic: exponents of ten
  double end_ = 1;
  std::vector<Tick> ticks_;
};

/// Position of a chart's interior in a drawing.
struct ChartArea {
  DrawingPoint corner;  ///< minimum x and y
  double width = 0;
  double height = 0;
};

/// Margins that draw_chart_frame() uses outside the area.
inline constexpr double kFrameLeft = 62;
inline constexpr double kFrameRight = 14;
inline constexpr double kFrameTop = 40;
inline constexpr double kFrameBottom = 38;

/// Draws the title, grid lines if `grid`, ticks with labels and the titles of both axes around
/// `area`.
void draw_chart_frame(const ChartArea& area, const std::string& title, const Axis& x_axis,
                      const Axis& y_axis, bool grid, Drawing& drawing);

/// The title of a whole page of charts, in its top left corner.
void draw_page_title(const std::string& title, Drawing& drawing);
inline constexpr double kPageTitleHeight = 30;

}  // namespace vantage
