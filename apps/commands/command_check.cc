#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/inputs/kitti_cameras_choice.h"
#include "apps/inputs/sampled_matches.h"
#include "apps/process/child_process.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/examination_report.h"
#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/image/stereo_packing.h"
#include "engine/io/images/stereo_jpeg.h"
#include "engine/jobs/sequence_session.h"
#include "engine/options/calibration_settings.h"
#include "engine/options/match_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/scene_mask_settings.h"

namespace vantage::apps {
namespace {

/// The first, the middle and the last pair of a sequence.
constexpr int kMaxExamined = 3;

struct CheckJob : SequenceJob {
  std::string left;
  std::string right;  ///< empty: `left` is of pictures that hold both images
  CommonOptions common;
};

/// What the examined pairs have in common.
struct CheckedPairs {
  SettingValue values = SettingValue::array();
  bool makes_sense = false;  ///< a match of any of them does
  std::string problem;       ///< the first one
  int exchanged_votes = 0;   ///< pairs that look exchanged less those that do not
  int rectified_votes = 0;   ///< likewise; pairs of too few points have none
  std::optional<DisparityRange> disparities;
  double seconds = 0;  ///< of the longest match

  void add(const PairExamination& found) {
    makes_sense = makes_sense || found.problems.empty();
    if (problem.empty() && !found.problems.empty()) {
      problem = found.problems.front();
    }
    if (const auto& error = found.rows.error) {
      exchanged_votes += error->looks_exchanged() ? 1 : -1;
      rectified_votes += rows_correspond(found.rows) ? kMaxExamined : -1;
    }
    if (const auto& own = found.disparities) {
      const DisparityRange all = disparities.value_or(*own);
      disparities = {std::min(all.min, own->min), std::max(all.max, own->max)};
    }
    seconds = std::max(seconds, found.seconds);
  }
};

void add_check_settings(Settings& settings, CheckJob& job) {
  settings.start_group("Input");
  settings
      .positional("left", job.left,
                  "Left photograph, or a sequence: a folder, a pattern (left/%06d.png), a glob or "
                  "a video; alone: pictures or a film that hold both images")
      .required = true;
  settings.positional("right", job.right, "Right photograph or sequence");
  add_pair_by_setting(settings, job.input.pair_by);
  settings.choice<StereoPacking>("packing", job.input.packing, stereo_packing_names(),
                                 "Stereo layout of pictures that hold both images, as of 'run'; "
                                 "auto: as the film says");
  add_deinterlace_setting(settings, job.input.reading);
  settings.input_path("calibration", job.calibration, "FILE",
                      "Cameras, to rectify the pair first: file of any tool, or two (A,B)");
  add_calibration_choice_settings(settings, job.calibration_choice);
  add_scene_mask_settings(settings, job.input.masks, true);
  add_white_level_setting(settings, job.input.white_level);
  add_reading_settings(settings, job.input.reading);
  add_match_settings(settings, job.sequence.match);
  add_common_settings(settings, job.common);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "packing", "calibration", "report", "threads", "quiet"},
      {"vantage check left.png right.png", "vantage check left/ right/ --report check.json",
       "vantage check film.mp4 --packing sbsl"});
}

void check(CheckJob& job, const Settings& settings) {
  if (job.calibration.empty()) {
    settings.refuse_idle({"kitti-cameras", "lens"}, "without --calibration");
  }
  if (!job.right.empty()) {
    settings.refuse_idle({"packing"}, "with two images or sequences");
    job.input.left = job.left;
    job.input.right = job.right;
  } else {
    job.input.stereo = job.left;
  }
  job.input.validate();
  job.sequence.match.validate();
  job.common.execution.validate();
  FileChecks files(settings);
  check_common_files(job.common, files);
}

/// The given options that change results, for another command.
std::string given_options(const Settings& settings, bool for_one_pair) {
  std::string text;
  for (const Setting& setting : settings.all()) {
    if (setting.changes_results && !(for_one_pair && setting.name == "pair-by") &&
        !setting.positional && settings.is_set(setting.name)) {
      const SettingValue value = setting.get();
      text += " --" + setting.name;
      text += setting.kind == ValueKind::kTruth ? ""
              : value.is_string()               ? "=" + shell_word(value.get<std::string>())
                                                : "=" + shell_word(value.dump());
    }
  }
  return text;
}

/// The command that makes maps of the pairs, or rectifies them first.
std::string command_of(const CheckJob& job, const Settings& settings, const CheckedPairs& checked,
                       int pair_count) {
  const bool is_exchanged = checked.exchanged_votes > 0;
  const std::string left = shell_word(is_exchanged ? job.right : job.left);
  const std::string right = shell_word(is_exchanged ? job.left : job.right);
  const std::string options = given_options(settings, pair_count == 1);
  if (job.right.empty()) {
    return fmt::format("vantage run --stereo {} -o results{}", shell_word(job.left), options);
  }
  if (checked.rectified_votes < 0 && job.calibration.empty()) {
    return fmt::format("vantage rectify {} {} -o rectified", left, right);
  }
  return pair_count == 1
             ? fmt::format("vantage match {} {} -o disparity.pfm{}", left, right, options)
             : fmt::format("vantage run --left {} --right {} -o results{}", left, right, options);
}

/// Planned memory of the command that is printed: `match` of one pair, `run` of more.
std::size_t planned_bytes(const CheckJob& job, const CheckedPairs& checked,
                          const SequenceSession& session, const FramePair& pair) {
  SequenceOptions options = job.sequence;
  options.match.disparities = *checked.disparities;
  options.match.disparities_auto = false;
  const auto in_flight = session.pairs->pair_count() == 1 ? std::optional(1) : std::nullopt;
  return plan_memory(options, {in_flight, std::nullopt}, session.shape, pair, job.common.execution)
      .total_bytes;
}

/// Reads and examines some of the pairs, the last one into `pair`. Returns the lines of the table.
std::string examine(CheckJob& job, const Settings& settings, Execution& execution,
                    RunReport& report, SequenceSession& session, FramePair& pair,
                    CheckedPairs& checked) {
  std::optional<StereoCalibration> calibration;
  if (!job.calibration.empty()) {
    choose_kitti_cameras(settings, job.common, job.calibration, session.pairs->files(),
                         job.calibration_choice);
    calibration = job.rig.read(job.calibration, job.calibration_choice);
  }
  const int pair_count = session.pairs->pair_count();
  std::string text;
  for (const std::string& remark : session.pairs->remarks()) {
    report.add_remark({Remark::Kind::kNote, "pairing", remark});
    text += table_line("note", with_dashes(remark));
  }
  for (const int index : sampled_pairs(pair_count, kMaxExamined)) {
    report.timed_file_access("read", [&] { read_equal_pair(*session.pairs, index, pair); });
    const bool is_first = checked.values.empty();
    is_first ? prepare_pairs(job, calibration, false, pair, execution, session)
             : session.rectify(pair, execution);
    PairExamination found = report.timed_compute("examine", [&] {
      return examine_pair(pair.left, pair.right, job.sequence.match, execution);
    });
    if (is_first) {
      const std::vector<Remark>& level = session.pairs->white_level().remarks;
      found.remarks.insert(found.remarks.begin(), level.begin(), level.end());
      if (const auto& cameras = session.shape.cameras) {
        found.remarks.insert(found.remarks.begin(), cameras->remarks.begin(),
                             cameras->remarks.end());
      }
    }
    for (const Remark& remark : found.remarks) {
      report.add_remark(remark);
    }
    text += table_line("pair", session.pairs->describe(index) +
                                   (pair_count == 1 ? "" : fmt::format(" of {}", pair_count)));
    text += examination_text(pair, found);
    checked.values.push_back(examination_values(pair, found));
    checked.add(found);
  }
  return text;
}

}  // namespace

int command_check(const Arguments& arguments) {
  CheckJob job;
  Settings settings("check",
                    "Says what a pair or a sequence is like, what a match of it would cost, and "
                    "which command to type. Exit code 1 where a match makes no sense.");
  add_check_settings(settings, job);
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  check(job, settings);
  CommandWork work(settings, job.common, reported_settings(settings, job.sequence.match));
  SequenceSession session;
  try {
    open_source(job, session);
  } catch (const UsageError& error) {
    if (!job.right.empty() || job.input.packing) {
      throw;
    }
    throw UsageError(fmt::format("RIGHT is missing; {}", error.what()));
  }
  FramePair pair;
  CheckedPairs checked;
  std::string text = examine(job, settings, work.execution, work.report, session, pair, checked);
  const int pair_count = session.pairs->pair_count();
  SettingValue results = {{"pair_count", pair_count}, {"makes_sense", checked.makes_sense}};
  if (const auto& cameras = session.shape.cameras) {
    text += table_line("calibration",
                       fmt::format("focal length {:.1f} px, baseline {:.4g} in its unit{}",
                                   cameras->left.matrix(0, 0), cameras->baseline,
                                   session.shape.is_rectified_here ? "; rectifies the pair" : ""));
  } else {
    text += table_line("calibration", "none: disparities, no depths");
  }
  if (checked.makes_sense) {
    const std::size_t bytes = planned_bytes(job, checked, session, pair);
    const double all_seconds = std::ceil(checked.seconds * pair_count);
    text += table_line(
        "cost", fmt::format("{:.2f} s for a pair{} on {} threads; {} MiB", checked.seconds,
                            pair_count == 1 ? "" : fmt::format(", {} s for all", all_seconds),
                            work.execution.executor().thread_count(), bytes >> 20U));
    results["disparities"] = to_text(*checked.disparities);
    results["seconds_per_pair"] = checked.seconds;
    results["memory_bytes"] = bytes;
  }
  if (checked.makes_sense || checked.rectified_votes < 0) {
    results["command"] = command_of(job, settings, checked, pair_count);
    text += table_line("command", results["command"]);
  }
  results["pairs"] = std::move(checked.values);
  work.report.set_results(std::move(results));
  work.report.write(job.common.report);
  if (!job.common.quiet) {
    fmt::print("{}", text);
  }
  if (!checked.makes_sense) {
    throw Error(
        fmt::format("{}: a match makes no sense: {}", session.pairs->describe(0), checked.problem));
  }
  return kExitDone;
}

}  // namespace vantage::apps
