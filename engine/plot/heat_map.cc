#include "engine/plot/heat_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/io/images/preview.h"
#include "engine/plot/axis.h"

namespace vantage {
namespace {

constexpr double kMapWidth = 320;
constexpr double kMinMapHeight = 90;
constexpr double kMaxMapHeight = 320;
constexpr double kScaleGap = 10;
constexpr double kScaleWidth = 12;
constexpr double kScaleLabels = 60;
constexpr double kHeatMapMargin = 16;
constexpr double kPanelWidth = kFrameLeft + kMapWidth + kScaleGap + kScaleWidth + kScaleLabels;

PreviewRange range_of(const Image<float>& values) {
  float min = std::numeric_limits<float>::infinity();
  float max = -min;
  for (int y = 0; y < values.height(); ++y) {
    for (int x = 0; x < values.width(); ++x) {
      if (std::isfinite(values.at(x, y))) {
        min = std::min(min, values.at(x, y));
        max = std::max(max, values.at(x, y));
      }
    }
  }
  if (!(min <= max)) {
    return {0, 1};
  }
  const float half = std::max(std::abs(min), std::abs(max)) * 1e-3F;
  return min < max ? PreviewRange{min, max}
                   : PreviewRange{min - std::max(half, 1e-3F), max + std::max(half, 1e-3F)};
}

double map_height(const HeatMap& map) {
  return std::clamp(kMapWidth * map.values.height() / map.values.width(), kMinMapHeight,
                    kMaxMapHeight);
}

void draw_colour_scale(const PreviewRange& range, const ChartArea& beside, Drawing& drawing) {
  constexpr int kSteps = 128;
  Image<float> ramp(1, kSteps);
  for (int y = 0; y < kSteps; ++y) {
    const float part = static_cast<float>(kSteps - 1 - y) / (kSteps - 1);
    ramp.at(0, y) = range.min_px + part * (range.max_px - range.min_px);
  }
  const double x = beside.corner.x + beside.width + kScaleGap;
  drawing.picture({x, beside.corner.y}, kScaleWidth, beside.height,
                  colour_preview(ramp.view(), range.min_px, range.max_px));
  const Axis axis({}, range.min_px, range.max_px, false);
  for (const Axis::Tick& tick : axis.ticks()) {
    const double y = beside.corner.y + (1 - tick.place) * beside.height;
    drawing.stroke({{x + kScaleWidth, y}, {x + kScaleWidth + 3, y}});
    drawing.text({x + kScaleWidth + 6, y + 0.35 * kTextSize}, tick.label);
  }
}

void draw_map(const HeatMap& map, const ChartArea& area, Drawing& drawing) {
  const PreviewRange range = range_of(map.values);
  drawing.picture(area.corner, area.width, area.height,
                  colour_preview(map.values.view(), range.min_px, range.max_px));
  // A value's square extends half a step to either side.
  const double x_end = map.x_first + map.values.width() - 0.5;
  const double y_end = map.y_first + map.values.height() - 0.5;
  const Axis x_axis({.title = map.x_title}, map.x_first - 0.5, x_end, false);
  const Axis y_axis({.title = map.y_title, .downwards = true}, map.y_first - 0.5, y_end, false);
  draw_chart_frame(area, map.title, x_axis, y_axis, false, drawing);
  if (map.marked) {
    constexpr Colour kMark{255, 255, 255};
    constexpr double kArm = 7;
    constexpr double kHole = 3;
    const double x = area.corner.x + x_axis.place(map.marked->first) * area.width;
    const double y = area.corner.y + (1 - y_axis.place(map.marked->second)) * area.height;
    for (const double side : {-1.0, 1.0}) {
      drawing.stroke({{x + side * kHole, y}, {x + side * kArm, y}}, 1.5, kMark);
      drawing.stroke({{x, y + side * kHole}, {x, y + side * kArm}}, 1.5, kMark);
    }
  }
  draw_colour_scale(range, area, drawing);
}

}  // namespace

Drawing draw_heat_maps(const std::string& title, const std::vector<HeatMap>& maps, int columns) {
  const int count = static_cast<int>(maps.size());
  const int used_columns = std::clamp(columns, 1, std::max(1, count));
  double height = kMinMapHeight;
  for (const HeatMap& map : maps) {
    height = std::max(height, map_height(map));
  }
  const double panel_height = kFrameTop + height + kFrameBottom;
  Drawing drawing;
  drawing.width = static_cast<int>(used_columns * kPanelWidth + kHeatMapMargin);
  draw_page_title(title, drawing);
  for (int i = 0; i < count; ++i) {
    const HeatMap& map = maps[static_cast<std::size_t>(i)];
    const ChartArea area = {{i % used_columns * kPanelWidth + kFrameLeft,
                             kPageTitleHeight + i / used_columns * panel_height + kFrameTop},
                            kMapWidth,
                            map_height(map)};
    draw_map(map, area, drawing);
  }
  const int rows = (count + used_columns - 1) / used_columns;
  drawing.height = static_cast<int>(kPageTitleHeight + rows * panel_height + kHeatMapMargin);
  return drawing;
}

}  // namespace vantage
