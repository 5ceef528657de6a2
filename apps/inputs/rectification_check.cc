#include "apps/inputs/rectification_check.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "apps/process/tell.h"
#include "apps/reports/vertical_error_report.h"
#include "engine/rectification/rows/row_check.h"
#include "engine/seconds_since.h"
#include "scheduler/trace.h"

namespace vantage::apps {
namespace {

RowCheck timed_check(const Photograph& left, const Photograph& right, Execution& execution,
                     RunReport& report) {
  const scheduler::Span span("check");
  const auto start = std::chrono::steady_clock::now();
  RowCheck check = check_rows(left, right, &execution);
  report.add_stage("check", seconds_since(start));
  return check;
}

std::string what_to_do(const RowTask& task, const RowCheck& check) {
  if (check.pays()) {
    return "; leave out --rows as-is to correct them";
  }
  return fmt::format("; that is more than --rows auto corrects{}",
                     task.lines == "rows" ? ", see 'vantage rectify'" : "");
}

void tell_of(const RowTask& task, const RowCheck& check, bool is_corrected, RunReport& report) {
  if (!check.error) {
    return;
  }
  const VerticalError& error = *check.error;
  const bool corresponds = is_corrected || (check.rows && !check.pays()) || is_rectified(error);
  const bool looks_exchanged = error.looks_exchanged() && !task.expects_negative;
  SettingValue values = vertical_error_values(error);
  values["is_rectified"] = corresponds;
  values["looks_exchanged"] = looks_exchanged;
  report.add_result("rectification", std::move(values));
  if (task.common.quiet) {
    return;
  }
  const std::string& command = task.settings.command();
  if (!corresponds) {
    tell("{}: warning: the pair is not rectified: {}; {}{}\n", command,
         cost_text(error, task.lines), vertical_error_text(error), what_to_do(task, check));
  }
  if (looks_exchanged) {
    tell("{}: warning: {}\n", command, exchanged_text(error, task.lines));
  }
}

}  // namespace

bool expects_negative_disparities(const MatchOptions& options) {
  return !options.disparities_auto && -options.disparities.min > options.disparities.max;
}

void add_row_settings(Settings& settings, RowSettings& rows) {
  settings.choice<RowMode>("rows", rows.mode, {{"auto", RowMode::kAuto}, {"as-is", RowMode::kAsIs}},
                           kRowsHelp);
  add_rectification_check_setting(
      settings, rows.check,
      "Do not look at the rows: correct nothing, and do not warn of pairs that are not rectified "
      "or whose left and right are exchanged");
}

void add_rectification_check_setting(Settings& settings, bool& wanted, const char* text) {
  Setting& setting = settings.add("no-rectification-check", "", text);
  setting.flag = true;
  setting.changes_results = false;  // rows do
  setting.set = [&wanted](const SettingValue& value) { wanted = !to_truth(value); };
  setting.get = [&wanted] { return !wanted; };
}

SettingValue row_values(const RowEstimate& rows, bool is_corrected) {
  return {{"offset_px", rows.field.offset_px()},
          {"turn_degrees", rows.field.turn_degrees()},
          {"largest_px", rows.field.max_px()},
          {"terms", rows.terms},
          {"residual_px", rows.residual_px},
          {"points", rows.inliers},
          {"corrected", is_corrected}};
}

std::optional<CorrectedRows> correct_rows(const RowTask& task, const Photograph& left,
                                          Photograph& right, Execution& execution,
                                          RunReport& report) {
  if (left.width() != right.width() || left.height() != right.height()) {
    return std::nullopt;
  }
  const RowCheck check = timed_check(left, right, execution, report);
  const bool corrects = task.mode == RowMode::kAuto && check.pays();
  if (check.rows && !task.is_of_sequence) {
    report.add_result("rows", row_values(*check.rows, corrects));
  }
  tell_of(task, check, corrects, report);
  if (!corrects || task.is_of_sequence) {
    return std::nullopt;
  }
  if (!task.common.quiet) {
    tell("{}: {}: {}; corrected, points agree to {:.2f} px\n", task.settings.command(), task.lines,
         row_text(*check.rows, task.lines), check.rows->residual_px);
  }
  CorrectedRows result{.field = check.rows->field, .given = {}};
  report.timed_compute("rows", [&] {
    Photograph corrected;
    vantage::correct_rows(right, result.field, corrected, execution);
    result.given = std::exchange(right, std::move(corrected));
  });
  return result;
}

}  // namespace vantage::apps
