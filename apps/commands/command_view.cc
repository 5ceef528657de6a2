#include <fmt/format.h>

#include <filesystem>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/inputs/pair_input.h"
#include "apps/pages/view_page.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/options/settings.h"
#include "engine/options/synthesis_settings.h"

namespace vantage::apps {
namespace {

struct ViewJob {
  PairInput pair;
  ViewPageOptions page;
  CommonOptions common;
  std::string output;
};

ViewRange to_view_range(const SettingValue& value) {
  return from_parts(value, ':', 2, "A:B with two positions in baselines, such as -0.5:1.5",
                    [](const auto& parts) {
                      return std::optional(ViewRange{to_number(parts[0]), to_number(parts[1])});
                    });
}

void add_range_setting(Settings& settings, const std::string& name, ViewRange& range,
                       const std::string& help) {
  Setting& setting = settings.add(name, "A:B", help);
  setting.set = [&range](const SettingValue& value) { range = to_view_range(value); };
  setting.get = [&range]() -> SettingValue {
    return fmt::format("{}:{}", range.first, range.last);
  };
}

void add_page_settings(Settings& settings, ViewPageOptions& page) {
  settings.start_group("Page");
  add_range_setting(settings, "range", page.range_x,
                    "Range of positions along the baseline: 0 left camera, 1 right camera");
  add_range_setting(settings, "vertical-range", page.range_y,
                    "Range of vertical positions in baselines, positive downwards; 0:0: none");
  settings.choice<PageImages>("images", page.images,
                              {{"png", PageImages::kPng}, {"jpeg", PageImages::kJpeg}},
                              "Image format in the page: lossless, or smaller");
  settings.start_group("View synthesis");
  settings.choice<HoleFilling>(
      "holes", page.synthesis.holes,
      {{"mirror", HoleFilling::kMirror},
       {"spread", HoleFilling::kSpread},
       {"none", HoleFilling::kNone}},
      "Filling of areas that no image shows: background mirrored along the row (mirror), its "
      "border pixel repeated (spread), or black (none)");
  add_combining_settings(settings, page.synthesis);
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

}  // namespace

int command_view(const Arguments& arguments) {
  ViewJob job;
  Settings settings("view",
                    "Writes a self-contained web page that renders new views of a rectified pair.");
  settings.start_group("Files");
  add_pair_settings(settings, job.pair);
  Setting& output = settings.path("output", job.output, "FILE.html", "Path to the page");
  output.short_name = 'o';
  output.required = true;
  add_page_settings(settings, job.page);
  add_match_settings(settings, job.pair.match);
  add_common_settings(settings, job.common);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "left-disparity", "right-disparity", "calibration", "output", "range",
       "vertical-range", "images", "holes", "disparities", "preset", "threads", "quiet"},
      {"vantage view left.png right.png -o pair.html",
       "vantage view left.png right.png -o pair.html --images jpeg --range 0:1",
       "vantage view left.jpg right.jpg --calibration rig.yml -o pair.html"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  job.page.validate();
  check_combining(settings, job.page.synthesis);
  job.common.execution.validate();
  check_pair(job.pair, settings);
  FileChecks files(settings);
  files.add_output(job.output, "--output", OutputKind::kPage);
  check_common_files(job.common, files);

  CommandWork work(settings, job.common, reported_settings(settings, job.pair));
  RunReport& report = work.report;
  Execution& execution = work.execution;
  const PairWithMaps pair = read_pair(job.pair, settings, job.common, execution, report);
  const std::string names = file_name(job.pair.left) + " and " + file_name(job.pair.right);
  const std::string page = report.timed_compute(
      "page", [&] { return make_view_page(pair, names, job.page, execution); });
  report.timed_file_access("write", [&] { write_text_file(job.output, page); });

  return work.finish(
      {{"page_bytes", page.size()}},
      fmt::format("{}x{} pixels, {:.1f} MB -> {}", pair.left.width(), pair.left.height(),
                  static_cast<double>(page.size()) / 1e6, job.output));
}

}  // namespace vantage::apps
