#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include "apps/commands/commands.h"
#include "apps/eval/folder_scores.h"
#include "apps/eval/score_columns.h"
#include "apps/eval/submission.h"
#include "apps/eval/view_comparison.h"
#include "apps/inputs/input_limits.h"
#include "apps/inputs/map_camera_input.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/error.h"
#include "engine/evaluation/disparity_evaluation.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/options/given_map_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

struct EvalJob {
  CommonOptions common;
  std::string first;
  std::string second;
  bool views = false;
  GivenMapOptions given;
  std::optional<double> truth_scale;
  MapCameraInput cameras;
  std::string mask;
  int ignore_border_px = 0;
  std::string csv;
  SubmissionOptions submission;

  [[nodiscard]] bool has_folders() const { return !views && std::filesystem::is_directory(second); }
};

constexpr std::string_view kLevels = "grey levels";

/// A row of the table on stdout.
struct Row {
  std::string_view label;
  std::string_view key;  ///< in the report
  double value;
  std::string_view unit;
};

void add_eval_settings(Settings& settings, EvalJob& job) {
  settings.start_group("Files");
  settings
      .positional(
          "disparity", job.first,
          "Disparity map to evaluate, or a folder of maps; with --views a picture, a folder "
          "of them or a video")
      .required = true;
  settings
      .positional("truth", job.second,
                  "True disparity map, or a folder of KITTI, Middlebury or ETH3D, or of true maps; "
                  "with --views the true photographs")
      .required = true;
  settings.flag("views", job.views, "Compare pictures, not disparity maps");
  settings.number(
      "scale", job.truth_scale, "S",
      "Divide values of an integer TRUTH file by S; auto: 256 for 16-bit PNG, in folders "
      "what Middlebury states; otherwise required for 8-bit files");
  add_given_map_settings(settings, job.given);
  settings.input_path(
      "mask", job.mask, "FILE",
      "Evaluate only pixels that are white in this 8-bit image; with --views it may "
      "be a folder or a video too");
  settings.integer("ignore-border", job.ignore_border_px, "PX",
                   "Number of rows and columns to leave out at each side");
  settings.start_group("Cameras, for given depths");
  add_map_camera_settings(settings, job.cameras, RigUse::kDepths);
  settings.start_group("Folders");
  settings.path("csv", job.csv, "FILE.csv", "Write the table of a folder");
  add_submission_settings(settings, job.submission);
}

void check(const EvalJob& job, const Settings& settings) {
  job.common.execution.validate();
  require_above_0("scale", job.truth_scale);
  job.given.validate(settings);
  job.cameras.validate(settings);
  if (job.given.holds_depths()) {
    job.cameras.rig.require_given(job.cameras.calibration, "given");
  } else {
    settings.refuse_idle({"calibration", "focal-length"}, "without --given depth");
  }
  check_submission(job.submission, settings);
  if (job.ignore_border_px < 0) {
    throw UsageError(
        fmt::format("--ignore-border is {}, expected at least 0", job.ignore_border_px));
  }
  if (job.views) {
    settings.refuse_idle({"scale", "disparity-scale", "given", "ignore-border"}, "with --views");
  }
  if (job.has_folders()) {
    settings.refuse_idle({"mask"}, "with folders");
    if (!std::filesystem::is_directory(job.first)) {
      throw UsageError(fmt::format("{} is no folder, but {} is one, expected two of them",
                                   job.first, job.second));
    }
  } else {
    settings.refuse_idle({"csv", "submission"}, "without folders");
  }
  FileChecks files(settings);
  files.add_output(job.csv, "--csv", OutputKind::kTable);
  if (!job.submission.folder.empty()) {
    files.add_made_folder(job.submission.folder, "--output");
  }
  check_common_files(job.common, files);
}

/// Adds to `remarks` what was assumed, of each subject once: the maps of a folder are alike.
DisparityMap read_map(const EvalJob& job, const std::string& path, Execution& execution,
                      std::vector<Remark>& remarks) {
  std::vector<Remark> found;
  std::vector<Remark> of_cameras;
  const auto camera = [&](int width, int height) {
    return job.cameras.camera(width, height, Side::kLeft, &of_cameras).scale;
  };
  DisparityMap map = read_given_map(path, job.given, camera, execution, found);
  found.insert(found.end(), of_cameras.begin(), of_cameras.end());
  std::ranges::copy_if(found, std::back_inserter(remarks), [told = remarks](const Remark& remark) {
    return std::ranges::count(told, remark.subject, &Remark::subject) == 0;
  });
  return map;
}

std::vector<Row> judge_disparity(const EvalJob& job, Execution& execution, RunReport& report) {
  std::vector<Remark> remarks;
  const auto maps = report.timed_file_access("read", [&] {
    return std::pair(read_map(job, job.first, execution, remarks),
                     read_disparity(job.second, job.truth_scale.value_or(0), &remarks));
  });
  tell_remarks(remarks, job.common, report);
  DisparityEvaluationOptions options;
  options.ignore_border_px = job.ignore_border_px;
  Mask mask;
  if (!job.mask.empty()) {
    mask = report.timed_file_access(
        "read", [&] { return white_pixels(read_photograph(job.mask), job.mask); });
    options.mask = mask.view();
  }
  const DisparityScores scores = report.timed_compute("evaluate", [&] {
    return evaluate_disparity(maps.first.view(), maps.second.view(), options);
  });
  std::vector<Row> rows = {
      {"pixels", "evaluated_pixels", static_cast<double>(scores.evaluated_pixels), ""},
      {"valid", "valid_pixels", static_cast<double>(scores.valid_pixels), ""}};
  for (const ScoreColumn& column : kScoreColumns) {
    rows.push_back({column.label, column.key, scores.*column.value, column.unit});
  }
  return rows;
}

/// Scores of a folder of maps, and files for a server.
void judge_folder(const EvalJob& job, Execution& execution, RunReport& report) {
  const BenchmarkFolder folder = read_benchmark_folder(job.second, job.first);
  std::vector<std::string> missing;
  for (const BenchmarkScene& scene : folder.scenes) {
    if (scene.map.empty()) {
      missing.push_back(scene.name);
    }
  }
  if (missing.size() == folder.scenes.size()) {
    throw Error(fmt::format("{}: holds no map of {}, expected files such as {}.pfm", job.first,
                            job.second, missing.front()));
  }
  std::vector<Remark> remarks = {{Remark::Kind::kNote, "layout",
                                  fmt::format("{} is taken as {} by what is in it; scenes: {}",
                                              job.second, folder.layout, folder.scenes.size())}};
  if (!missing.empty()) {
    remarks.push_back({Remark::Kind::kWarning, "missing",
                       fmt::format("{} of {} maps are missing in {}: {}", missing.size(),
                                   folder.scenes.size(), job.first, fmt::join(missing, ", "))});
  }
  const auto read_into = [&](std::vector<Remark>& found) -> ReadMap {
    return [&](const std::filesystem::path& file) {
      return read_map(job, file.string(), execution, found);
    };
  };
  const SettingValue rows = report.timed_compute("evaluate", [&] {
    return score_folder(folder, read_into(remarks), job.truth_scale.value_or(0),
                        job.ignore_border_px);
  });
  if (rows.empty() && (!job.submission.kind || !job.csv.empty())) {
    throw Error(
        fmt::format("{}: is a test set without truth, expected --submission alone", job.second));
  }
  tell_remarks(remarks, job.common, report);
  report.set_results({{"scores", rows}, {"missing", missing}});
  if (!rows.empty()) {
    fmt::print("{}", score_table(rows));
  }
  if (!job.csv.empty()) {
    write_text_file(job.csv, score_csv(rows));
  }
  if (job.submission.kind) {
    std::vector<Remark> told;
    const std::string line = report.timed_file_access("write", [&] {
      return write_submission(job.submission, job.second, folder, read_into(told));
    });
    if (!job.common.quiet) {
      tell("eval: {}\n", line);
    }
  }
}

std::vector<Row> judge_views(const EvalJob& job, Execution& execution, RunReport& report,
                             SettingValue& frames) {
  const ViewComparison compared = report.timed_compute(
      "evaluate", [&] { return compare_views(job.first, job.second, job.mask, execution); });
  tell_remarks(compared.remarks, job.common, report);
  const ViewScores& scores = compared.scores;
  std::vector<Row> rows = {
      {"pixels", "pixels", static_cast<double>(scores.pixels), ""},
      {"PSNR", "psnr_db", scores.psnr_db, "dB"},
      {"IV-PSNR", "iv_psnr_db", compared.immersive_psnr_db, "dB"},
      {"mean |difference|", "mean_absolute_difference", scores.mean_absolute_difference, kLevels},
      {"SSIM", "ssim", scores.ssim.value_or(std::nan("")), ""}};
  if (compared.frames.size() > 1) {
    rows.push_back(
        {"flicker", "flicker_levels", compared.flicker.mean_levels().value_or(0), kLevels});
    if (!job.mask.empty()) {
      rows.push_back({"flicker in mask", "masked_flicker_levels",
                      compared.flicker.masked_mean_levels().value_or(std::nan("")), kLevels});
    }
    frames = compared.frames;
  }
  return rows;
}

SettingValue results_of(const std::vector<Row>& rows) {
  SettingValue results = SettingValue::object();
  for (const Row& row : rows) {
    // JSON has no infinity and no NaN: null, as the library writes them.
    results[std::string(row.key)] = row.value;
  }
  return results;
}

void print_table(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    const bool is_count = row.unit.empty() && std::abs(row.value) > 1;
    fmt::print("{:<18} {:>12} {}\n", row.label,
               std::isnan(row.value) ? "-" : fmt::format("{:.{}f}", row.value, is_count ? 0 : 3),
               row.unit);
  }
}

}  // namespace

int command_eval(const Arguments& arguments) {
  EvalJob job;
  Settings settings(
      "eval",
      "Compares a disparity map, a folder of maps or, with --views, pictures with the truth.");
  add_eval_settings(settings, job);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"disparity", "truth", "views", "scale", "disparity-scale", "given", "mask", "ignore-border",
       "csv", "submission", "output", "report", "quiet"},
      {"vantage eval disparity.pfm truth.pfm", "vantage eval disparity.pfm truth.png --scale 4",
       "vantage eval maps kitti/training --csv kitti.csv",
       "vantage eval --views view.png photograph.png",
       "vantage eval --views results/views photographs --mask results/holes"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  check(job, settings);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;
  if (job.has_folders()) {
    judge_folder(job, execution, report);
  } else {
    SettingValue frames;
    const std::vector<Row> rows = job.views ? judge_views(job, execution, report, frames)
                                            : judge_disparity(job, execution, report);
    print_table(rows);
    SettingValue results = results_of(rows);
    if (!frames.is_null()) {
      results["frames"] = frames;
    }
    report.set_results(results);
  }
  report.write(job.common.report);
  return kExitDone;
}

}  // namespace vantage::apps
