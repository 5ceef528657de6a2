#include "apps/inputs/rectification_check.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <optional>
#include <string_view>

#include "apps/process/tell.h"
#include "apps/reports/vertical_error_report.h"
#include "engine/rectification/vertical_error.h"
#include "engine/seconds_since.h"
#include "scheduler/trace.h"

namespace vantage::apps {
namespace {

constexpr std::string_view kRows = "rows";

/// A check of rows, and how long it took.
struct RowCheck {
  std::optional<VerticalError> error;
  double seconds = 0;
};

RowCheck check_rows(const Photograph& left, const Photograph& right) {
  const scheduler::Span span("check");
  const auto start = std::chrono::steady_clock::now();
  RowCheck check;
  check.error = check_rectification(left, right);
  check.seconds = seconds_since(start);
  return check;
}

void tell_of(const RowCheck& check, const Settings& settings, const CommonOptions& common,
             bool expects_negative, std::string_view lines, RunReport& report) {
  report.add_stage("check", check.seconds);
  if (!check.error) {
    return;
  }
  const VerticalError& error = *check.error;
  SettingValue values = vertical_error_values(error);
  values["is_rectified"] = is_rectified(error);
  const bool looks_exchanged = error.looks_exchanged() && !expects_negative;
  values["looks_exchanged"] = looks_exchanged;
  report.add_result("rectification", std::move(values));
  if (!is_rectified(error) && !common.quiet) {
    tell("{}: warning: the pair is not rectified: {}; {}{}\n", settings.command(),
         cost_text(error, lines), vertical_error_text(error),
         lines == kRows ? "; see 'vantage rectify'" : "");
  }
  if (looks_exchanged && !common.quiet) {
    tell("{}: warning: {}\n", settings.command(), exchanged_text(error));
  }
}

}  // namespace

bool expects_negative_disparities(const MatchOptions& options) {
  return !options.disparities_auto && -options.disparities.min > options.disparities.max;
}

void add_rectification_check_setting(Settings& settings, bool& wanted, const char* text) {
  Setting& setting = settings.add("no-rectification-check", "", text);
  setting.flag = true;
  setting.changes_results = false;
  setting.set = [&wanted](const SettingValue& value) { wanted = !to_truth(value); };
  setting.get = [&wanted] { return !wanted; };
}

void warn_unless_rectified(const Settings& settings, const CommonOptions& common,
                           bool expects_negative, const Photograph& left, const Photograph& right,
                           RunReport& report) {
  // The user of the pair reports images of different sizes.
  if (left.width() == right.width() && left.height() == right.height()) {
    tell_of(check_rows(left, right), settings, common, expects_negative, kRows, report);
  }
}

void warn_unless_rectified_beside(const std::function<void()>& work, const Settings& settings,
                                  const CommonOptions& common, bool expects_negative,
                                  std::string_view lines, const Photograph& left,
                                  const Photograph& right, Execution& execution,
                                  RunReport& report) {
  RowCheck check;
  execution.executor().parallel_for(2, [&](int task) {
    if (task == 0) {
      work();
    } else {
      check = check_rows(left, right);
    }
  });
  tell_of(check, settings, common, expects_negative, lines, report);
}

}  // namespace vantage::apps
