#include "apps/match/check_job.h"

#include <fmt/format.h>

#include <optional>

#include "apps/commands/commands.h"
#include "apps/inputs/kitti_cameras_choice.h"
#include "apps/inputs/sampled_matches.h"
#include "apps/process/child_process.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/reports/examination_report.h"
#include "engine/error.h"
#include "engine/jobs/sequence_session.h"
#include "engine/options/match_settings.h"

namespace vantage::apps {
namespace {

/// The first, the middle and the last pair of a sequence.
constexpr int kMaxExamined = 3;

void check(CheckJob& job, const Settings& settings) {
  if (job.calibration.empty()) {
    settings.refuse_idle({"kitti-cameras"}, "without --calibration");
  }
  if (job.right.empty()) {
    if (!job.input.packing) {
      throw UsageError(
          "RIGHT is missing; for pictures that hold both images give --packing, such as sbsl");
    }
    job.input.stereo = job.left;
  } else {
    settings.refuse_idle({"packing"}, "with two images or sequences");
    job.input.left = job.left;
    job.input.right = job.right;
  }
  job.input.validate();
  job.sequence.match.validate();
  job.common.execution.validate();
  FileChecks files(settings);
  check_common_files(job.common, files);
}

/// What the user gave `check` beside images and the like, as options of another command.
std::string given_options(const Settings& settings) {
  std::string text;
  for (const Setting& setting : settings.all()) {
    const bool is_of_match = setting.changes_results && !setting.positional;
    if (is_of_match && settings.is_set(setting.name) && !setting.is_empty()) {
      text += " --" + setting.name;
      const SettingValue value = setting.get();
      if (!setting.flag) {
        text += " " + shell_word(value.is_string() ? value.get<std::string>() : value.dump());
      }
    }
  }
  return text;
}

/// The command that makes maps of what was checked, or rectifies it first.
std::string command_of(const CheckJob& job, const Settings& settings, const CheckedInput& checked) {
  const bool is_exchanged = checked.looks_exchanged();
  const std::string left = shell_word(is_exchanged ? job.right : job.left);
  const std::string right = shell_word(is_exchanged ? job.left : job.right);
  if (job.right.empty()) {
    return fmt::format("vantage run --stereo {} -o results", shell_word(job.left)) +
           given_options(settings);
  }
  if (checked.is_unrectified() && job.calibration.empty()) {
    return fmt::format("vantage rectify {} {} -o rectified", left, right);
  }
  return (checked.pair_count == 1
              ? fmt::format("vantage match {} {} -o disparity.pfm", left, right)
              : fmt::format("vantage run --left {} --right {} -o results", left, right)) +
         given_options(settings);
}

/// Of a match of the pair, or of a run of all pairs.
std::size_t memory_bytes(const CheckJob& job, const CheckedInput& checked,
                         const SequenceSession& session, const FramePair& pair) {
  SequenceOptions options = job.sequence;
  options.match.disparities = *checked.disparities();
  options.match.disparities_auto = false;
  const auto in_flight = checked.pair_count == 1 ? std::optional(1) : std::nullopt;
  return plan_memory(options, {in_flight, std::nullopt}, session.shape, pair, job.common.execution)
      .total_bytes;
}

}  // namespace

int run_check(CheckJob& job, const Settings& settings) {
  check(job, settings);
  CommandWork work(settings, job.common, reported_settings(settings, job.sequence.match));
  RunReport& report = work.report;
  Execution& execution = work.execution;
  SequenceSession session;
  open_source(job, session);
  std::optional<StereoCalibration> calibration;
  if (!job.calibration.empty()) {
    choose_kitti_cameras(settings, job.common, job.calibration, session.pairs->files(),
                         job.kitti_cameras);
    calibration = job.rig.read(job.calibration, job.kitti_cameras);
  }
  CheckedInput checked;
  checked.pair_count = session.pairs->pair_count();
  checked.threads = execution.executor().thread_count();
  FramePair pair;
  for (const int index : sampled_pairs(checked.pair_count, kMaxExamined)) {
    report.timed_file_access("read", [&] { read_equal_pair(*session.pairs, index, pair); });
    if (checked.pairs.empty()) {
      prepare_pairs(job, calibration, false, pair, execution, session);
    } else {
      session.rectify(pair, execution);
    }
    ExaminedPair& examined = checked.pairs.emplace_back();
    examined.index = index;
    examined.name = session.pairs->describe(index);
    examined.found = report.timed_compute("examine", [&] {
      return examine_pair(pair.left, pair.right, job.sequence.match, execution);
    });
    if (index == 0) {
      const std::vector<Remark>& level = session.pairs->white_level().remarks;
      examined.found.remarks.insert(examined.found.remarks.begin(), level.begin(), level.end());
    }
    for (const Remark& remark : examined.found.remarks) {
      report.add_remark(remark);
    }
  }
  checked.cameras = session.shape.cameras;
  checked.is_rectified_here = session.shape.is_rectified_here;
  if (checked.makes_sense()) {
    checked.memory_bytes = memory_bytes(job, checked, session, pair);
  }
  if (checked.makes_sense() || checked.is_unrectified()) {
    checked.command = command_of(job, settings, checked);
  }
  report.set_results(examination_values(checked));
  report.write(job.common.report);
  if (!job.common.quiet) {
    fmt::print("{}", examination_text(checked));
  }
  if (!checked.makes_sense()) {
    throw Error(fmt::format("{}: a match makes no sense: {}", checked.pairs.front().name,
                            checked.pairs.front().found.problems.front()));
  }
  return kExitDone;
}

}  // namespace vantage::apps
