#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/plot/axis.h"
#include "engine/plot/drawing.h"

namespace vantage {

/// SVG that lies within a page: the page's style sheet gives classes their colours, light and dark,
/// and shapes may have a text that shows when a pointer rests on them. A Drawing of engine/plot has
/// neither, but is a file of its own. Texts are plain, places in drawing units. Shapes whose place
/// is not finite are left out.
class SvgPicture {
 public:
  /// `description` is for those who cannot see it.
  SvgPicture(double width, double height, std::string_view description);

  void line(const std::vector<DrawingPoint>& points, std::string_view classes,
            std::string_view hint = "");
  void box(DrawingPoint corner, double width, double height, std::string_view classes,
           std::string_view hint = "");
  void disc(DrawingPoint centre, double radius, std::string_view classes,
            std::string_view hint = "");
  /// Of kTextSize. Classes "middle" and "end" say where `baseline` is; without, its begin.
  void text(DrawingPoint baseline, std::string_view text, std::string_view classes = "");

  /// The whole element.
  [[nodiscard]] std::string markup() const;

 private:
  double width_;
  double height_;
  std::string description_;
  std::string shapes_;
};

/// Room around the area of a chart for what draw_axes() writes.
inline constexpr double kAxesLeft = 50;
inline constexpr double kAxesRight = 14;
inline constexpr double kAxesTop = 24;
inline constexpr double kAxesBottom = 40;

/// Grid lines, ticks with labels, and titles around `area`.
void draw_axes(const ChartArea& area, const Axis& x_axis, const Axis& y_axis, SvgPicture& picture);
/// The same with ticks at `x_ticks` instead of those of the axis.
void draw_axes(const ChartArea& area, const Axis& x_axis, const std::vector<Axis::Tick>& x_ticks,
               const Axis& y_axis, SvgPicture& picture);

/// Where a value of both axes is; not finite if an axis cannot show it.
DrawingPoint place_in(const ChartArea& area, const Axis& x_axis, const Axis& y_axis, double x,
                      double y);

}  // namespace vantage
