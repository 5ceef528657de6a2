#include "apps/inputs/rectification_check.h"

#include <chrono>
#include <utility>
#include <vector>

#include "apps/reports/remarks.h"
#include "apps/reports/vertical_error_report.h"
#include "engine/options/match_settings.h"
#include "engine/rectification/rows/row_remarks.h"
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

void report_error(const RowCheck& check, const RowUse& use, RunReport& report) {
  if (check.error) {
    SettingValue values = vertical_error_values(*check.error);
    values["is_rectified"] = rows_correspond(check, use);
    values["looks_exchanged"] = looks_exchanged(check, use);
    report.add_result("rectification", std::move(values));
  }
}

}  // namespace

void add_row_settings(Settings& settings, RowSettings& rows) {
  add_rows_setting(settings, rows.mode);
  add_rectification_check_setting(
      settings, rows.check,
      "Do not look at the rows: correct nothing, and do not warn of pairs that are not rectified "
      "or whose left and right are exchanged");
}

void add_rectification_check_setting(Settings& settings, bool& wanted, const char* text) {
  Setting& setting = settings.add("no-rectification-check", "", text);
  setting.kind = ValueKind::kTruth;
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
  const RowUse use{
      .is_corrected = corrects, .expects_negative = task.expects_negative, .lines = task.lines};
  report_error(check, use, report);
  std::vector<Remark> remarks = row_remarks(check, use);
  if (task.is_of_sequence) {  // which says itself what it corrects
    std::erase_if(remarks, [](const Remark& remark) { return !remark.is_warning(); });
  }
  tell_remarks(remarks, task.common, report);
  if (!corrects || task.is_of_sequence) {
    return std::nullopt;
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
