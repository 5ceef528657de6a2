#include <fmt/format.h>

#include <cmath>

#include "apps/pages/comfort_page.h"
#include "engine/build_info.h"

namespace vantage::apps {
namespace {

/// Digits beyond these are noise.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

template <typename Value>
SettingValue or_null(const std::optional<Value>& value) {
  return value ? SettingValue(rounded(*value)) : SettingValue(nullptr);
}

SettingValue border_values(const ComfortSummary::Border& border) {
  return {{"frames", border.frames},
          {"worst_rows_percent", rounded(border.rows_percent)},
          {"worst_disparity_px", rounded(border.disparity_px)},
          {"worst_frame", border.worst_frame}};
}

SettingValue limit_values(const ComfortLimit& limit, const char* unit) {
  return {{"borderline_above", limit.borderline}, {"unsafe_above", limit.unsafe}, {"unit", unit}};
}

SettingValue summary_values(const ComfortSummary& summary, const ComfortPage& page) {
  SettingValue findings = SettingValue::array();
  for (const ComfortFinding& finding : summary.findings) {
    findings.push_back({{"name", finding.name},
                        {"verdict", std::string(name_of(finding.verdict))},
                        {"text", finding.text}});
  }
  const auto& px = summary.percentiles_px;
  return {{"first_frame", summary.span.first_frame},
          {"end_frame", summary.span.end_frame},
          {"start_seconds", rounded(page.seconds(summary.span.first_frame))},
          {"frames_measured", summary.frames},
          {"verdict", std::string(name_of(summary.verdict))},
          {"percentiles_px",
           {{"1", rounded(px[0])},
            {"5", rounded(px[1])},
            {"50", rounded(px[2])},
            {"95", rounded(px[3])},
            {"99", rounded(px[4])}}},
          {"crossed_percent", rounded(summary.crossed_percent)},
          {"uncrossed_percent", rounded(summary.uncrossed_percent)},
          {"depth_budget_percent", rounded(summary.budget_percent)},
          {"matched_percent", rounded(summary.matched_percent)},
          {"left_border", border_values(summary.borders[0])},
          {"right_border", border_values(summary.borders[1])},
          {"jump_px", or_null(summary.jump_px)},
          {"vertical_error_px", or_null(summary.vertical_px)},
          {"vertical_offset_px", or_null(summary.vertical_mean_px)},
          {"exchanged", summary.exchanged},
          {"places_in_order", summary.order_right},
          {"places_exchanged", summary.order_wrong},
          {"colour_difference_levels",
           {rounded(summary.colour[0]), rounded(summary.colour[1]), rounded(summary.colour[2])}},
          {"advised_shift_px", rounded(summary.shift_px)},
          {"advised_shift_percent", rounded(100 * summary.shift_px / summary.width_px)},
          {"findings", findings}};
}

SettingValue limits_values() {
  const ComfortLimits limits;
  return {{"crossed", limit_values(limits.crossed, "% of the width")},
          {"uncrossed", limit_values(limits.uncrossed, "% of the width")},
          {"depth_budget", limit_values(limits.depth_budget, "% of the width")},
          {"border_rows", limit_values(limits.border, "% of the height")},
          {"jump", limit_values(limits.jump, "% of the width")},
          {"vertical_error", limit_values(limits.vertical, "% of the height")},
          {"colour_difference", limit_values(limits.colour, "levels of 255")}};
}

}  // namespace

SettingValue comfort_values(const ComfortPage& page) {
  SettingValue shots = SettingValue::array();
  for (const ComfortSummary& shot : page.report.shots) {
    shots.push_back(summary_values(shot, page));
  }
  SettingValue sources = SettingValue::array();
  for (const std::string_view source : kComfortSources) {
    sources.push_back(std::string(source));
  }
  const ComfortSummary& film = page.report.film;
  return {{"version", build_info().version},
          {"input", page.input},
          {"frames_per_second", to_string(page.rate)},
          {"width_px", film.width_px},
          {"height_px", film.height_px},
          {"sign", "disparities are x_left - x_right: positive is crossed, in front of the screen"},
          {"limits", limits_values()},
          {"sources", sources},
          {"film", summary_values(film, page)},
          {"shots", shots}};
}

}  // namespace vantage::apps
