#include "engine/plot/surface_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/plot/axis.h"

namespace vantage {
namespace {

constexpr double kSurfaceSide = 170;  // of the longer side of the grid
constexpr double kSurfaceHeight = 110;
constexpr double kSurfaceMargin = 26;
constexpr double kSurfaceTop = 44;
constexpr double kCosine = 0.866;  // of 30°
constexpr double kSine = 0.5;
constexpr double kPanelSide = 2 * kCosine * kSurfaceSide + 2 * kSurfaceMargin;
constexpr double kSurfacePanelHeight =
    kSurfaceTop + kSurfaceHeight + 2 * kSine * kSurfaceSide + 2 * kSurfaceMargin;

/// From the grid to the drawing.
class Projection {
 public:
  Projection(const SurfacePlot& plot, DrawingPoint corner) {
    for (int y = 0; y < plot.values.height(); ++y) {
      for (int x = 0; x < plot.values.width(); ++x) {
        const double value = plot.values.at(x, y);
        if (std::isfinite(value)) {
          min = std::min(min, value);
          max = std::max(max, value);
        }
      }
    }
    if (!(min <= max)) {
      min = max = 0;
    }
    const double columns = plot.values.width() - 1;
    const double rows = plot.values.height() - 1;
    scale_ = kSurfaceSide / std::max(columns, rows);
    const double width = (columns + rows) * scale_ * kCosine;
    origin_ = {corner.x + (kPanelSide - width) / 2 + rows * scale_ * kCosine,
               corner.y + kSurfaceTop + kSurfaceHeight};
  }
  /// 0 at the smallest value, 1 at the largest.
  [[nodiscard]] double height_of(double value) const {
    return max > min ? (value - min) / (max - min) : 0;
  }
  [[nodiscard]] DrawingPoint point(double x, double y, double value) const {
    return {origin_.x + (x - y) * scale_ * kCosine,
            origin_.y + (x + y) * scale_ * kSine - height_of(value) * kSurfaceHeight};
  }

  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();

 private:
  double scale_ = 1;
  DrawingPoint origin_;
};

/// Dark blue to light yellow, so that grey prints keep the order.
Colour colour_of_height(double height) {
  const auto level = [height](double low, double high) {
    return static_cast<std::uint8_t>(std::lround(low + height * (high - low)));
  };
  return {level(50, 250), level(80, 235), level(140, 170)};
}

void draw_meshes(const SurfacePlot& plot, const Projection& projection, Drawing& drawing) {
  const int columns = plot.values.width();
  const int rows = plot.values.height();
  const int step = std::max(1, (std::max(columns, rows) + plot.max_meshes - 2) / plot.max_meshes);
  // The farthest first: rows from the back to the front, and columns of a row from left to right
  // hide none to their left.
  for (int y = 0; y + 1 < rows; y += step) {
    for (int x = 0; x + 1 < columns; x += step) {
      const int right = std::min(x + step, columns - 1);
      const int front = std::min(y + step, rows - 1);
      const std::array<std::pair<int, int>, 4> corners = {
          {{x, y}, {right, y}, {right, front}, {x, front}}};
      std::vector<DrawingPoint> mesh;
      double sum = 0;
      for (const auto& [corner_x, corner_y] : corners) {
        const double value = plot.values.at(corner_x, corner_y);
        sum += value;
        mesh.push_back(projection.point(corner_x, corner_y, value));
      }
      if (std::isfinite(sum)) {
        drawing.polygon(mesh, colour_of_height(std::clamp(projection.height_of(sum / 4), 0.0, 1.0)),
                        {70, 70, 70});
      }
    }
  }
}

void draw_surface(const SurfacePlot& plot, DrawingPoint corner, Drawing& drawing) {
  const Projection projection(plot, corner);
  drawing.text({corner.x + kSurfaceMargin, corner.y + 14}, plot.title);
  drawing.text({corner.x + kSurfaceMargin, corner.y + 14 + kTextSize + 3},
               fmt::format("{}: {:.4g} to {:.4g}", plot.z_title, projection.min, projection.max));
  const int last_x = plot.values.width() - 1;
  const int last_y = plot.values.height() - 1;
  const double floor = projection.min;
  drawing.stroke({projection.point(0, 0, floor), projection.point(last_x, 0, floor),
                  projection.point(last_x, last_y, floor), projection.point(0, last_y, floor),
                  projection.point(0, 0, floor)},
                 0.8);
  draw_meshes(plot, projection, drawing);
  // Axes run along the front edges.
  const auto below = [&](double x, double y, double dx, std::string words, TextAnchor anchor) {
    const DrawingPoint point = projection.point(x, y, floor);
    drawing.text({point.x + dx, point.y + kTextSize + 3}, std::move(words), anchor);
  };
  below(0, last_y, -4, fmt::format("{}", plot.x_first), TextAnchor::kMiddle);
  below(last_x / 2.0, last_y, -8, plot.x_title, TextAnchor::kEnd);
  below(last_x, last_y, -14, fmt::format("{}", plot.x_first + last_x), TextAnchor::kEnd);
  below(last_x, last_y, 14, fmt::format("{}", plot.y_first + last_y), TextAnchor::kBegin);
  below(last_x, last_y / 2.0, 8, plot.y_title, TextAnchor::kBegin);
  below(last_x, 0, 4, fmt::format("{}", plot.y_first), TextAnchor::kMiddle);
}

}  // namespace

Drawing draw_surface_plots(const std::string& title, const std::vector<SurfacePlot>& plots,
                           int columns) {
  const int count = static_cast<int>(plots.size());
  const int used_columns = std::clamp(columns, 1, std::max(1, count));
  const int rows = (count + used_columns - 1) / used_columns;
  Drawing drawing;
  drawing.width = static_cast<int>(
      std::max(used_columns * kPanelSide, kSurfaceMargin + text_width(title, kTextSize + 5)));
  drawing.height = static_cast<int>(kPageTitleHeight + rows * kSurfacePanelHeight);
  draw_page_title(title, drawing);
  for (int i = 0; i < count; ++i) {
    draw_surface(
        plots[static_cast<std::size_t>(i)],
        {i % used_columns * kPanelSide, kPageTitleHeight + i / used_columns * kSurfacePanelHeight},
        drawing);
  }
  return drawing;
}

}  // namespace vantage
