#include "engine/profile_page/speed_up_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "engine/profile_page/quantity_text.h"
#include "engine/profile_page/svg_picture.h"

namespace vantage {
namespace {

constexpr double kSpeedUpWidth = 440;
constexpr double kSpeedUpHeight = 320;
constexpr double kCap = 4;

/// Amdahl's law, `ratio` times as many threads.
double amdahl_speed_up(double serial_fraction, double ratio) {
  return 1 / (serial_fraction + (1 - serial_fraction) / ratio);
}

}  // namespace

std::string speed_up_chart(const Profile& profile) {
  const double fewest = profile.speed_ups.front().threads;
  const double most = profile.speed_ups.back().threads;
  double highest = most / fewest;
  for (const SpeedUp& speed_up : profile.speed_ups) {
    highest = std::max(highest, speed_up.ratio.most);
  }
  const Axis x_axis({.title = "threads"}, 0, most, false);
  const Axis y_axis(
      {.title = fmt::format("times as fast as {} thread{}", fewest, fewest == 1 ? "" : "s")}, 0,
      highest * 1.04, false);
  const ChartArea area = {{kAxesLeft, kAxesTop},
                          kSpeedUpWidth - kAxesLeft - kAxesRight,
                          kSpeedUpHeight - kAxesTop - kAxesBottom};
  SvgPicture picture(kSpeedUpWidth, kSpeedUpHeight, "Speed-up against the number of threads");
  std::vector<Axis::Tick> measured;
  for (const SpeedUp& speed_up : profile.speed_ups) {
    measured.push_back({x_axis.place(speed_up.threads), std::to_string(speed_up.threads)});
  }
  draw_axes(area, x_axis, measured, y_axis, picture);
  const auto point = [&](double x, double y) { return place_in(area, x_axis, y_axis, x, y); };
  picture.line({point(fewest, 1), point(most, most / fewest)}, "ideal");
  if (profile.serial_fraction) {
    constexpr int kSteps = 60;
    std::vector<DrawingPoint> curve;
    for (int i = 0; i <= kSteps; ++i) {
      const double threads = fewest + (most - fewest) * i / kSteps;
      curve.push_back(point(threads, amdahl_speed_up(*profile.serial_fraction, threads / fewest)));
    }
    picture.line(curve, "fitted");
  }
  for (const SpeedUp& speed_up : profile.speed_ups) {
    const double threads = speed_up.threads;
    const DrawingPoint low = point(threads, speed_up.ratio.least);
    const DrawingPoint high = point(threads, speed_up.ratio.most);
    picture.line({{low.x - kCap, low.y},
                  {low.x + kCap, low.y},
                  low,
                  high,
                  {high.x - kCap, high.y},
                  {high.x + kCap, high.y}},
                 "range");
    picture.disc(
        point(threads, speed_up.ratio.median), 4, "measured",
        fmt::format("{} threads: {}", speed_up.threads, plain_sample_text(speed_up.ratio, "×")));
  }
  return picture.markup();
}

}  // namespace vantage
