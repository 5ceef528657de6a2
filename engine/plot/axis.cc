#include "engine/plot/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vantage {
namespace {

constexpr int kMaxSteps = 6;

/// The smallest of 1, 2 and 5 times a power of ten that covers `span` in at most kMaxSteps steps.
double round_step(double span) {
  const double power = std::pow(10, std::floor(std::log10(span / kMaxSteps)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power * kMaxSteps >= span * (1 - 1e-9)) {
      return factor * power;
    }
  }
  return 10 * power;
}

}  // namespace

Axis::Axis(AxisOptions options, double min, double max, bool round_ends)
    : options_(std::move(options)) {
  if (!std::isfinite(min) || !std::isfinite(max)) {
    min = max = options_.scale == AxisScale::kLogarithmic ? 1 : 0;
  }
  begin_ = std::min(min, max);
  end_ = std::max(min, max);
  if (options_.scale == AxisScale::kCategories) {
    begin_ = 0;
    end_ = std::max<double>(1, static_cast<double>(options_.categories.size()) - 1);
    for (std::size_t i = 0; i < options_.categories.size(); ++i) {
      ticks_.push_back({place(static_cast<double>(i)), options_.categories[i]});
    }
  } else if (options_.scale == AxisScale::kLogarithmic) {
    make_logarithmic_ticks(round_ends);
  } else {
    make_linear_ticks(round_ends);
  }
}

double Axis::place(double value) const {
  if (options_.scale == AxisScale::kLogarithmic) {
    if (!(value > 0)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    value = std::log10(value);
  }
  const double place = (value - begin_) / (end_ - begin_);
  return options_.downwards ? 1 - place : place;
}

void Axis::make_linear_ticks(bool round_ends) {
  // If all values are equal, their magnitude determines a reasonable range.
  const double size = std::max(std::abs(begin_), std::abs(end_));
  if (end_ - begin_ <= 1e-12 * size || end_ == begin_) {
    const double half = size > 0 ? size / 2 : 0.5;
    begin_ -= half;
    end_ += half;
  }
  const double step = round_step(end_ - begin_);
  if (round_ends) {
    begin_ = std::floor(begin_ / step + 1e-9) * step;
    end_ = std::ceil(end_ / step - 1e-9) * step;
  }
  const double slack = 1e-9 * (end_ - begin_);
  const auto first = std::ceil((begin_ - slack) / step);
  for (int i = 0; (first + i) * step <= end_ + slack; ++i) {
    const double value = (first + i) * step;
    ticks_.push_back({place(value), fmt::format("{:.6g}", value == 0 ? 0 : value)});
  }
}

void Axis::make_logarithmic_ticks(bool round_ends) {
  const double floor = std::numeric_limits<double>::min();
  begin_ = std::log10(std::max(begin_, floor));
  end_ = std::log10(std::max(end_, floor));
  if (end_ - begin_ < 1e-9) {
    begin_ -= 0.5;
    end_ += 0.5;
  }
  if (round_ends) {
    begin_ = std::floor(begin_ + 1e-9);
    end_ = std::ceil(end_ - 1e-9);
  }
  const int decade_step = std::max(1, static_cast<int>(std::ceil((end_ - begin_) / kMaxSteps)));
  const bool few_decades = end_ - begin_ <= 2;
  const auto first = static_cast<int>(std::floor(begin_));
  for (int exponent = first; exponent <= end_ + 1e-9; ++exponent) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10, exponent);
      const bool wanted = factor == 1 ? exponent % decade_step == 0 : few_decades;
      const double at = place(value);
      if (wanted && at >= -1e-9 && at <= 1 + 1e-9) {
        ticks_.push_back({at, fmt::format("{:.6g}", value)});
      }
    }
  }
}

void draw_chart_frame(const ChartArea& area, const std::string& title, const Axis& x_axis,
                      const Axis& y_axis, bool grid, Drawing& drawing) {
  constexpr double kTick = 4;
  constexpr Colour kGridInk{225, 225, 225};
  const double left = area.corner.x;
  const double right = area.corner.x + area.width;
  const double top = area.corner.y;
  const double bottom = area.corner.y + area.height;

  double last_label_end = -std::numeric_limits<double>::infinity();
  for (const Axis::Tick& tick : x_axis.ticks()) {
    const double x = left + tick.place * area.width;
    if (grid) {
      drawing.stroke({{x, top}, {x, bottom}}, 1, kGridInk);
    }
    drawing.stroke({{x, bottom}, {x, bottom + kTick}});
    const double half = text_width(tick.label, kTextSize) / 2;
    if (x - half > last_label_end) {  // omits labels that would overlap
      drawing.text({x, bottom + kTick + kTextSize}, tick.label, TextAnchor::kMiddle);
      last_label_end = x + half + 2;
    }
  }
  for (const Axis::Tick& tick : y_axis.ticks()) {
    const double y = bottom - tick.place * area.height;
    if (grid) {
      drawing.stroke({{left, y}, {right, y}}, 1, kGridInk);
    }
    drawing.stroke({{left - kTick, y}, {left, y}});
    drawing.text({left - kTick - 3, y + 0.35 * kTextSize}, tick.label, TextAnchor::kEnd);
  }
  drawing.stroke({{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}});

  drawing.text({left, top - 22}, title, TextAnchor::kBegin, kTextSize + 2);
  // Next to the axis it would have to be rotated; above it is easier to read.
  drawing.text({left, top - 6}, y_axis.title());
  drawing.text({(left + right) / 2, bottom + kTick + 2.2 * kTextSize + 2}, x_axis.title(),
               TextAnchor::kMiddle);
}

void draw_page_title(const std::string& title, Drawing& drawing) {
  drawing.text({16, 21}, title, TextAnchor::kBegin, kTextSize + 5);
}

}  // namespace vantage
