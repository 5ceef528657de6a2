#include "engine/comfort/comfort_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/order_statistics.h"

namespace vantage {
namespace {

constexpr std::array kReported = {0.01, 0.05, 0.5, 0.95, 0.99};
/// Fewer places tell nothing about the order of the images.
constexpr int kMinVotes = 100;
constexpr double kClearVotes = 2;

using Frames = std::vector<std::pair<int, const FrameComfort*>>;

double pixels(int units) { return static_cast<double>(units) / kComfortPerPixel; }
double share_percent(int share) { return 100.0 * share / kComfortWhole; }

/// Share of a frame's pixels that have at most disparity `value`, in units: between the known
/// shares a straight line.
double share_up_to(const FrameComfort& frame, double value) {
  const auto& known = frame.disparity;
  if (value >= known.back()) {
    return 1;
  }
  const auto above = std::ranges::upper_bound(known, value);
  if (above == known.begin()) {
    return 0;
  }
  const auto i = static_cast<std::size_t>(above - known.begin());
  const double span = known[i] - known[i - 1];
  return kComfortShares[i - 1] +
         (kComfortShares[i] - kComfortShares[i - 1]) * (value - known[i - 1]) / span;
}

/// The disparity that `share` of the pixels of all frames have at most; each frame counts the same.
double pooled_percentile(const Frames& frames, double share) {
  double low = frames.front().second->disparity.front();
  double high = frames.front().second->disparity.back();
  for (const auto& [number, frame] : frames) {
    low = std::min<double>(low, frame->disparity.front());
    high = std::max<double>(high, frame->disparity.back());
  }
  while (high - low > 0.25) {
    const double middle = (low + high) / 2;
    double sum = 0;
    for (const auto& [number, frame] : frames) {
      sum += share_up_to(*frame, middle);
    }
    (sum >= share * static_cast<double>(frames.size()) ? high : low) = middle;
  }
  return high / kComfortPerPixel;
}

template <typename Value>
std::optional<double> median_of(const Frames& frames, const Value& value) {
  std::vector<int> values;
  for (const auto& [number, frame] : frames) {
    if (frame->vertical) {
      values.push_back(value(*frame->vertical));
    }
  }
  if (values.empty()) {
    return std::nullopt;
  }
  return pixels(upper_median(values));
}

void add_borders(const Frames& frames, const ComfortLimits& limits, ComfortSummary& summary) {
  for (std::size_t side = 0; side < 2; ++side) {
    ComfortSummary::Border& border = summary.borders[side];
    for (const auto& [number, frame] : frames) {
      const double rows = share_percent(frame->borders[side].rows);
      border.frames += rows > limits.border.borderline ? 1 : 0;
      if (rows > border.rows_percent) {
        border.rows_percent = rows;
        border.disparity_px = pixels(frame->borders[side].disparity);
        border.worst_frame = number;
      }
    }
  }
}

double shift_percent(double far, double near, const ComfortLimits& limits) {
  const double up = -limits.uncrossed.borderline - far;  // at least this, for what is far
  const double down = limits.crossed.borderline - near;  // at most this, for what is near
  return up > down ? (up + down) / 2 : std::clamp(0.0, up, down);
}

void judge(const ComfortLimits& limits, ComfortSummary& summary) {
  const auto add = [&](const char* name, ComfortVerdict verdict, std::string text) {
    summary.findings.push_back({name, verdict, std::move(text)});
    summary.verdict = std::max(summary.verdict, verdict);
  };
  add("crossed", limits.crossed.of(summary.crossed_percent),
      fmt::format("{:.2f} % of the width in front of the screen", summary.crossed_percent));
  add("uncrossed", limits.uncrossed.of(summary.uncrossed_percent),
      fmt::format("{:.2f} % of the width behind the screen", summary.uncrossed_percent));
  add("depth budget", limits.depth_budget.of(summary.budget_percent),
      fmt::format("{:.2f} % of the width from near to far", summary.budget_percent));
  for (std::size_t side = 0; side < 2; ++side) {
    const ComfortSummary::Border& border = summary.borders[side];
    add(side == 0 ? "left border" : "right border", limits.border.of(border.rows_percent),
        border.rows_percent == 0
            ? std::string("nothing in front of the screen is cut")
            : fmt::format("something {:.1f} px in front of the screen is cut in {:.0f} % of the "
                          "rows (frame {}; {} of {} frames)",
                          border.disparity_px, border.rows_percent, border.worst_frame,
                          border.frames, summary.frames));
  }
  if (summary.jump_px) {
    const double jump = 100 * *summary.jump_px / summary.width_px;
    add("jump", limits.jump.of(std::abs(jump)),
        fmt::format("{:+.2f} % of the width at the cut before it", jump));
  }
  if (summary.vertical_px) {
    add("vertical error", limits.vertical.of(100 * *summary.vertical_px / summary.height_px),
        fmt::format("{:.2f} px", *summary.vertical_px));
  }
  add("order", summary.exchanged ? ComfortVerdict::kUnsafe : ComfortVerdict::kSafe,
      summary.exchanged ? "left and right are exchanged" : "left and right are as they should be");
  double colour = 0;
  for (const double channel : summary.colour) {
    colour = std::max(colour, std::abs(channel));
  }
  add("colour", limits.colour.of(colour),
      fmt::format("{:.1f} of 255 levels between the images", colour));
}

ComfortSummary summary_of(const Frames& frames, ComfortSpan span, const ComfortLimits& limits) {
  ComfortSummary summary;
  summary.span = span;
  summary.frames = static_cast<int>(frames.size());
  summary.width_px = frames.front().second->width_px;
  summary.height_px = frames.front().second->height_px;
  for (std::size_t i = 0; i < kReported.size(); ++i) {
    summary.percentiles_px[i] = pooled_percentile(frames, kReported[i]);
  }
  const double per_width = 100.0 / summary.width_px;
  const double far = per_width * summary.percentiles_px.front();
  const double near = per_width * summary.percentiles_px.back();
  summary.crossed_percent = std::max(0.0, near);
  summary.uncrossed_percent = std::max(0.0, -far);
  summary.budget_percent = near - far;
  summary.shift_px = shift_percent(far, near, limits) / per_width;
  add_borders(frames, limits, summary);
  summary.vertical_px =
      median_of(frames, [](const FrameComfort::Vertical& one) { return one.systematic; });
  summary.vertical_mean_px =
      median_of(frames, [](const FrameComfort::Vertical& one) { return one.mean; });
  for (const auto& [number, frame] : frames) {
    summary.matched_percent += share_percent(frame->matched) / summary.frames;
    summary.order_right += frame->order_right;
    summary.order_wrong += frame->order_wrong;
    for (std::size_t c = 0; c < summary.colour.size(); ++c) {
      summary.colour[c] +=
          static_cast<double>(frame->colour[c]) / kComfortPerGreyLevel / summary.frames;
    }
  }
  summary.exchanged = summary.order_right + summary.order_wrong >= kMinVotes &&
                      summary.order_wrong > kClearVotes * summary.order_right;
  return summary;
}

Frames frames_in(const std::map<int, FrameComfort>& frames, ComfortSpan span) {
  Frames chosen;
  for (auto one = frames.lower_bound(span.first_frame);
       one != frames.end() && one->first < span.end_frame; ++one) {
    chosen.emplace_back(one->first, &one->second);
  }
  return chosen;
}

}  // namespace

std::string_view name_of(ComfortVerdict verdict) {
  switch (verdict) {
    case ComfortVerdict::kSafe:
      return "safe";
    case ComfortVerdict::kBorderline:
      return "borderline";
    case ComfortVerdict::kUnsafe:
      break;
  }
  return "unsafe";
}

ComfortReport summarise_comfort(const std::map<int, FrameComfort>& frames,
                                const std::vector<ComfortSpan>& shots) {
  const ComfortLimits limits;
  ComfortReport report;
  if (shots.empty()) {
    return report;
  }
  const FrameComfort* last = nullptr;
  for (const ComfortSpan span : shots) {
    const Frames of_shot = frames_in(frames, span);
    if (of_shot.empty()) {
      continue;
    }
    ComfortSummary summary = summary_of(of_shot, span, limits);
    constexpr auto kHalf =
        static_cast<std::size_t>(std::ranges::find(kComfortShares, 0.5) - kComfortShares.begin());
    if (last != nullptr) {
      summary.jump_px = pixels(of_shot.front().second->disparity[kHalf] - last->disparity[kHalf]);
    }
    last = of_shot.back().second;
    judge(limits, summary);
    report.shots.push_back(std::move(summary));
  }
  const ComfortSpan whole{shots.front().first_frame, shots.back().end_frame};
  const Frames all = frames_in(frames, whole);
  if (!all.empty()) {
    report.film = summary_of(all, whole, limits);
    // Shots are exchanged one by one: those that are not must not outvote the others.
    report.film.exchanged = std::ranges::any_of(report.shots, &ComfortSummary::exchanged);
    judge(limits, report.film);
    for (const ComfortSummary& shot : report.shots) {
      report.film.verdict = std::max(report.film.verdict, shot.verdict);
    }
  }
  return report;
}

}  // namespace vantage
