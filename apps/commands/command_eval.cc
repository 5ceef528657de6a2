#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/error.h"
#include "engine/evaluation/disparity_evaluation.h"
#include "engine/evaluation/view_evaluation.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

struct EvalJob {
  CommonOptions common;
  std::string first;
  std::string second;
  bool views = false;
  std::optional<double> truth_scale;
  std::optional<double> disparity_scale;
  std::string mask;
  int ignore_border_px = 0;
};

/// A row of the table on stdout.
struct Row {
  const char* label;
  const char* key;  ///< in the report
  double value;
  const char* unit;
};

void add_eval_settings(Settings& settings, EvalJob& job) {
  settings.start_group("Files");
  settings
      .positional("disparity", job.first, "Disparity map to evaluate; with --views a photograph")
      .required = true;
  settings.positional("truth", job.second, "True disparity map; with --views the true photograph")
      .required = true;
  settings.flag("views", job.views, "Compare two photographs, not disparity maps");
  settings.number("scale", job.truth_scale, "S",
                  "Divide values of an integer TRUTH file by S; auto: 256 for 16-bit PNG; required "
                  "for 8-bit files");
  settings.number("disparity-scale", job.disparity_scale, "S",
                  "Divide values of an integer DISPARITY file by S, as --scale");
  settings.input_path("mask", job.mask, "FILE",
                      "Evaluate only pixels that are white in this 8-bit image");
  settings.integer("ignore-border", job.ignore_border_px, "PX",
                   "Number of rows and columns to leave out at each side");
}

void check(const EvalJob& job, const Settings& settings) {
  job.common.execution.validate();
  require_above_0("scale", job.truth_scale);
  require_above_0("disparity-scale", job.disparity_scale);
  if (job.ignore_border_px < 0) {
    throw UsageError(
        fmt::format("--ignore-border is {}, expected at least 0", job.ignore_border_px));
  }
  if (job.views && (job.truth_scale || job.disparity_scale || job.ignore_border_px != 0)) {
    throw UsageError("--scale, --disparity-scale and --ignore-border cannot be used with --views");
  }
  FileChecks files(settings);
  check_common_files(job.common, files);
}

/// 255 where all colours of an 8-bit image are 255. Masks often come with a palette, hence in
/// colour.
Mask read_mask(const std::string& path) {
  const Photograph photograph = read_photograph(path);
  const auto* pixels = std::get_if<Image<std::uint8_t>>(&photograph.pixels);
  if (pixels == nullptr) {
    throw Error(fmt::format("{}: not a mask, expected an 8-bit image", path));
  }
  const int colours = std::min(pixels->channels(), 3);
  Mask mask(pixels->width(), pixels->height());
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const std::uint8_t* pixel = pixels->row(y) + x * pixels->channels();
      const bool is_white = std::all_of(pixel, pixel + colours, [](int v) { return v == 255; });
      mask.at(x, y) = is_white ? 255 : 0;
    }
  }
  return mask;
}

std::vector<Row> judge_disparity(const EvalJob& job, RunReport& report) {
  const auto maps = report.timed_file_access("read", [&] {
    return std::pair(read_disparity(job.first, job.disparity_scale.value_or(0)),
                     read_disparity(job.second, job.truth_scale.value_or(0)));
  });
  DisparityEvaluationOptions options;
  options.ignore_border_px = job.ignore_border_px;
  Mask mask;
  if (!job.mask.empty()) {
    mask = report.timed_file_access("read", [&] { return read_mask(job.mask); });
    options.mask = mask.view();
  }
  const DisparityScores scores = report.timed_compute("evaluate", [&] {
    return evaluate_disparity(maps.first.view(), maps.second.view(), options);
  });
  return {{"pixels", "evaluated_pixels", static_cast<double>(scores.evaluated_pixels), ""},
          {"valid", "valid_pixels", static_cast<double>(scores.valid_pixels), ""},
          {"coverage", "coverage_percent", scores.coverage_percent, "%"},
          {"bad 0.5", "bad_0_5_percent", scores.bad_0_5_percent, "%"},
          {"bad 1", "bad_1_percent", scores.bad_1_percent, "%"},
          {"bad 2", "bad_2_percent", scores.bad_2_percent, "%"},
          {"bad 4", "bad_4_percent", scores.bad_4_percent, "%"},
          {"average", "average_px", scores.average_px, "px"},
          {"RMS", "rms_px", scores.rms_px, "px"},
          {"A50", "a50_px", scores.a50_px, "px"},
          {"A90", "a90_px", scores.a90_px, "px"},
          {"A95", "a95_px", scores.a95_px, "px"},
          {"A99", "a99_px", scores.a99_px, "px"}};
}

std::vector<Row> judge_view(const EvalJob& job, Execution& execution, RunReport& report) {
  const auto photographs = report.timed_file_access(
      "read", [&] { return std::pair(read_photograph(job.first), read_photograph(job.second)); });
  Mask mask;
  std::optional<ImageView<const std::uint8_t>> counted;
  if (!job.mask.empty()) {
    mask = report.timed_file_access("read", [&] { return read_mask(job.mask); });
    counted = mask.view();
  }
  const ViewScores scores = report.timed_compute("evaluate", [&] {
    return evaluate_view(photographs.first, photographs.second, execution, counted);
  });
  return {{"pixels", "pixels", static_cast<double>(scores.pixels), ""},
          {"PSNR", "psnr_db", scores.psnr_db, "dB"},
          {"mean |difference|", "mean_absolute_difference", scores.mean_absolute_difference,
           "grey levels"},
          {"SSIM", "ssim", scores.ssim.value_or(std::nan("")), ""}};
}

SettingValue results_of(const std::vector<Row>& rows) {
  SettingValue results = SettingValue::object();
  for (const Row& row : rows) {
    // JSON has no infinity and no NaN: null, as the library writes them.
    results[row.key] = row.value;
  }
  return results;
}

void print_table(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    const bool is_count = *row.unit == '\0' && std::abs(row.value) > 1;
    fmt::print("{:<18} {:>12} {}\n", row.label,
               std::isnan(row.value) ? "-" : fmt::format("{:.{}f}", row.value, is_count ? 0 : 3),
               row.unit);
  }
}

}  // namespace

int command_eval(const Arguments& arguments) {
  EvalJob job;
  Settings settings("eval",
                    "Compares a disparity map or, with --views, a photograph with the truth.");
  add_eval_settings(settings, job);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"disparity", "truth", "views", "scale", "disparity-scale", "mask", "ignore-border", "report",
       "quiet"},
      {"vantage eval disparity.pfm truth.pfm", "vantage eval disparity.pfm truth.png --scale 4",
       "vantage eval --views view.png photograph.png"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  check(job, settings);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;
  const std::vector<Row> rows =
      job.views ? judge_view(job, execution, report) : judge_disparity(job, report);
  print_table(rows);
  report.set_results(results_of(rows));
  report.write(job.common.report);
  return kExitDone;
}

}  // namespace vantage::apps
