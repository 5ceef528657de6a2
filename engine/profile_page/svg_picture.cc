#include "engine/profile_page/svg_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "engine/io/markup_text.h"

namespace vantage {
namespace {

bool is_finite(const DrawingPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y);
}

// What ends an element: with a hint it has one inside.
std::string end_of(std::string_view element, std::string_view hint) {
  return hint.empty() ? "/>\n"
                      : fmt::format("><title>{}</title></{}>\n", escaped_markup(hint), element);
}

}  // namespace

SvgPicture::SvgPicture(double width, double height, std::string_view description)
    : width_(width), height_(height), description_(description) {}

void SvgPicture::line(const std::vector<DrawingPoint>& points, std::string_view classes,
                      std::string_view hint) {
  if (!std::ranges::all_of(points, is_finite)) {
    return;
  }
  shapes_ += fmt::format("<polyline class=\"{}\" points=\"", classes);
  for (const DrawingPoint& point : points) {
    fmt::format_to(std::back_inserter(shapes_), "{:.1f},{:.1f} ", point.x, point.y);
  }
  shapes_ += "\"" + end_of("polyline", hint);
}

void SvgPicture::box(DrawingPoint corner, double width, double height, std::string_view classes,
                     std::string_view hint) {
  if (!is_finite(corner) || !std::isfinite(width) || !std::isfinite(height)) {
    return;
  }
  fmt::format_to(std::back_inserter(shapes_),
                 "<rect class=\"{}\" x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{:.1f}\"",
                 classes, corner.x, corner.y, width, height);
  shapes_ += end_of("rect", hint);
}

void SvgPicture::disc(DrawingPoint centre, double radius, std::string_view classes,
                      std::string_view hint) {
  if (!is_finite(centre) || !std::isfinite(radius)) {
    return;
  }
  fmt::format_to(std::back_inserter(shapes_),
                 "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"", classes, centre.x,
                 centre.y, radius);
  shapes_ += end_of("circle", hint);
}

void SvgPicture::text(DrawingPoint baseline, std::string_view text, std::string_view classes) {
  if (!is_finite(baseline)) {
    return;
  }
  const std::string attribute = classes.empty() ? "" : fmt::format(" class=\"{}\"", classes);
  fmt::format_to(std::back_inserter(shapes_), "<text{} x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                 attribute, baseline.x, baseline.y, escaped_markup(text));
}

std::string SvgPicture::markup() const {
  return fmt::format(
      "<svg role=\"img\" aria-label=\"{2}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "style=\"max-width:{0:.0f}px\">\n{3}</svg>\n",
      width_, height_, escaped_markup(description_), shapes_);
}

void draw_axes(const ChartArea& area, const Axis& x_axis, const Axis& y_axis, SvgPicture& picture) {
  draw_axes(area, x_axis, x_axis.ticks(), y_axis, picture);
}

void draw_axes(const ChartArea& area, const Axis& x_axis, const std::vector<Axis::Tick>& x_ticks,
               const Axis& y_axis, SvgPicture& picture) {
  const double left = area.corner.x;
  const double right = left + area.width;
  const double top = area.corner.y;
  const double bottom = top + area.height;
  double last_label_end = -std::numeric_limits<double>::infinity();
  for (const Axis::Tick& tick : x_ticks) {
    const double x = left + tick.place * area.width;
    picture.line({{x, top}, {x, bottom}}, "grid");
    const double half = text_width(tick.label, kTextSize) / 2;
    if (x - half > last_label_end) {  // labels that would overlap are left out
      picture.text({x, bottom + 6 + kTextSize}, tick.label, "tick middle");
      last_label_end = x + half + 2;
    }
  }
  for (const Axis::Tick& tick : y_axis.ticks()) {
    const double y = bottom - tick.place * area.height;
    picture.line({{left, y}, {right, y}}, "grid");
    picture.text({left - 6, y + 0.35 * kTextSize}, tick.label, "tick end");
  }
  picture.line({{left, top}, {left, bottom}, {right, bottom}}, "axis");
  // Beside the axis it would have to be turned; above it reads as well.
  picture.text({left - kAxesLeft + 4, top - 10}, y_axis.title());
  picture.text({right, bottom + 12 + 2 * kTextSize}, x_axis.title(), "end");
}

DrawingPoint place_in(const ChartArea& area, const Axis& x_axis, const Axis& y_axis, double x,
                      double y) {
  return {area.corner.x + x_axis.place(x) * area.width,
          area.corner.y + (1 - y_axis.place(y)) * area.height};
}

}  // namespace vantage
