#include "apps/rectification_check.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "apps/vertical_error_report.h"
#include "engine/rectification/vertical_error.h"

namespace vantage::apps {
namespace {

/// Real rectified pairs are within a quarter of a pixel; from here on sub-pixel matching suffers.
constexpr double kLimit_px = 0.3;

}  // namespace

void add_rectification_check_setting(Settings& settings, bool& wanted) {
  Setting& setting =
      settings.add("no-rectification-check", "",
                   "Do not look whether rows correspond, nor warn when they are off by more than "
                   "0.3 pixels");
  setting.flag = true;
  setting.changes_results = false;
  setting.set = [&wanted](const SettingValue& value) { wanted = !to_truth(value); };
  setting.get = [&wanted] { return !wanted; };
}

void warn_unless_rectified(const Settings& settings, const CommonOptions& common,
                           const Photograph& left, const Photograph& right, RunReport& report) {
  if (left.width() != right.width() || left.height() != right.height()) {
    return;  // whoever uses the pair will say so
  }
  const auto start = std::chrono::steady_clock::now();
  const auto error = check_rectification(left, right);
  report.add_stage("check",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (!error) {
    return;
  }
  SettingValue values = vertical_error_values(*error);
  const bool is_rectified = error->systematic_px <= kLimit_px;
  values["limit_px"] = kLimit_px;
  values["is_rectified"] = is_rectified;
  report.add_result("rectification", std::move(values));
  if (!is_rectified && !common.quiet) {
    fmt::print(stderr,
               "{}: warning: the pair is not rectified: rows are off by {:.2f} px (limit {}), {}; "
               "see 'vantage rectify'\n",
               settings.command(), error->systematic_px, kLimit_px, vertical_error_text(*error));
  }
}

}  // namespace vantage::apps
