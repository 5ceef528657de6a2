#include "engine/profile_page/roofline_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/profile_page/label_places.h"
#include "engine/profile_page/quantity_text.h"
#include "engine/profile_page/svg_picture.h"

namespace vantage {
namespace {

constexpr double kRooflineWidth = 536;  // half a page
constexpr double kRooflineHeight = 400;
constexpr double kLargestRadius = 17;
constexpr double kLeastRadius = 3.5;

struct PlacedStage {
  const StageProfile* stage;
  RooflinePlace place;
};

struct Range {
  double least;
  double most;

  void include(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

std::string hint_of(const PlacedStage& placed) {
  return fmt::format(
      "{}: {} of a thread, {} GFLOP/s, {} GB/s, {} operations per byte, {} of its roof ({})",
      placed.stage->name, quantity_text(placed.stage->seconds.median, "s"),
      number_text(placed.place.gflops), number_text(placed.place.gb_per_s),
      number_text(placed.place.operations_per_byte), percent_text(placed.place.roof_share),
      placed.place.roof == Roof::kArithmetic ? "arithmetic" : "L2 bandwidth");
}

class RooflineChart {
 public:
  RooflineChart(const ThreadRoofs& roofs, const Range& x, const Range& y)
      : roofs_(roofs),
        x_(x),
        x_axis_({.title = "operations per byte", .scale = AxisScale::kLogarithmic}, x.least, x.most,
                false),
        y_axis_({.title = "GFLOP/s of one thread", .scale = AxisScale::kLogarithmic}, y.least,
                y.most, false),
        y_least_(y.least),
        picture_(kRooflineWidth, kRooflineHeight,
                 "Roofline: arithmetic of the stages against their operations per byte") {
    draw_axes(area_, x_axis_, y_axis_, picture_);
    draw_bandwidth(roofs.memory_gb_per_s, "memory");
    draw_bandwidth(roofs.l2_gb_per_s, "L2");
    const double peak = roofs_.gflops;
    draw_roof(point(std::min(peak / roofs.l2_gb_per_s, x.most), peak), point(x.most, peak));
    name_roof(point(x.most, peak), fmt::format("arithmetic {} GFLOP/s", number_text(peak)));
  }

  void add_stage(const PlacedStage& placed, double radius) {
    const DrawingPoint centre = point(placed.place.operations_per_byte, placed.place.gflops);
    const std::string_view classes =
        placed.place.roof == Roof::kArithmetic ? "disc arithmetic" : "disc bandwidth";
    picture_.disc(centre, radius, classes, hint_of(placed));
    labels_.push_back({centre, radius, placed.stage->name});
  }

  std::string finish() {
    const std::vector<LabelPlace> places = place_labels(labels_, area_);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const LabelPlace& place = places[i];
      if (labels_[i].label.empty()) {
        continue;
      }
      if (place.is_far && labels_[i].radius > 0) {
        const DrawingPoint& centre = labels_[i].centre;
        picture_.line({{std::clamp(centre.x, place.corner.x, place.corner.x + place.width),
                        std::clamp(centre.y, place.corner.y, place.corner.y + place.height)},
                       centre},
                      "leader");
      }
      picture_.text({place.corner.x + place.width / 2, place.corner.y + 0.95 * kTextSize},
                    labels_[i].label, labels_[i].radius > 0 ? "label middle" : "roof-name middle");
    }
    return picture_.markup();
  }

 private:
  [[nodiscard]] DrawingPoint point(double x, double y) const {
    return place_in(area_, x_axis_, y_axis_, x, y);
  }

  /// From where it enters the chart to where arithmetic limits it.
  void draw_bandwidth(double gb_per_s, std::string_view name) {
    const double begin = std::max(x_.least, y_least_ / gb_per_s);
    const double end = std::min(x_.most, roofs_.gflops / gb_per_s);
    if (begin >= end) {
      return;
    }
    draw_roof(point(begin, begin * gb_per_s), point(end, end * gb_per_s));
    const double named = begin * std::pow(end / begin, 0.07);  // beside its lower end
    name_roof(point(named, named * gb_per_s),
              fmt::format("{} {} GB/s", name, number_text(gb_per_s)));
  }

  void draw_roof(DrawingPoint begin, DrawingPoint end) {
    picture_.line({begin, end}, "roof");
    constexpr int kObstacles = 80;  // along it, for labels to keep clear of
    for (int i = 0; i <= kObstacles; ++i) {
      const double way = static_cast<double>(i) / kObstacles;
      labels_.push_back(
          {{std::lerp(begin.x, end.x, way), std::lerp(begin.y, end.y, way)}, 1.5, ""});
    }
  }

  void name_roof(DrawingPoint place, std::string name) {
    labels_.push_back({place, 0, std::move(name)});
  }

  ThreadRoofs roofs_;
  Range x_;
  Axis x_axis_;
  Axis y_axis_;
  double y_least_;
  ChartArea area_{{kAxesLeft, kAxesTop},
                  kRooflineWidth - kAxesLeft - kAxesRight,
                  kRooflineHeight - kAxesTop - kAxesBottom};
  SvgPicture picture_;
  std::vector<LabelledDisc> labels_;
};

}  // namespace

std::string roofline_chart(const std::vector<StageProfile>& stages, const ThreadRoofs& roofs) {
  std::vector<PlacedStage> placed;
  // Both corners of the roofs are always to be seen.
  Range x = {roofs.gflops / roofs.l2_gb_per_s, roofs.gflops / roofs.memory_gb_per_s};
  Range y = {roofs.gflops, roofs.gflops};
  double most_s = 0;
  for (const StageProfile& stage : stages) {
    if (const auto place = place_on_roofline(stage, roofs)) {
      placed.push_back({&stage, *place});
      x.include(place->operations_per_byte);
      y.include(place->gflops);
      most_s = std::max(most_s, stage.seconds.median);
    }
  }
  if (placed.empty()) {
    return "";
  }
  std::ranges::stable_sort(placed, std::ranges::greater{},
                           [](const PlacedStage& stage) { return stage.stage->seconds.median; });
  x = {std::min(x.least, x.most) / 3, x.most * 2.5};
  y = {y.least / 3, y.most * 2};
  RooflineChart chart(roofs, x, y);
  for (const PlacedStage& stage : placed) {
    const double radius = kLargestRadius * std::sqrt(stage.stage->seconds.median / most_s);
    chart.add_stage(stage, std::max(radius, kLeastRadius));
  }
  return chart.finish();
}

}  // namespace vantage
