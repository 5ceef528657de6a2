#include "apps/match/rectify_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "apps/commands/commands.h"
#include "apps/inputs/kitti_cameras_choice.h"
#include "apps/inputs/sampled_matches.h"
#include "apps/match/rectified_files.h"
#include "apps/process/command_work.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/board_report.h"
#include "apps/reports/rectify_results.h"
#include "apps/reports/remarks.h"
#include "apps/reports/run_report.h"
#include "engine/error.h"
#include "engine/image/left_out.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/images/photograph_io.h"
#include "engine/rectification/board/board_calibration.h"
#include "engine/rectification/feature_matches.h"
#include "engine/rectification/improved_rectification.h"
#include "engine/rectification/rectification_file.h"
#include "engine/rectification/rectifier.h"
#include "engine/rectification/uncalibrated_rig.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxSamplePairs = 1000;
constexpr int kSamplePairs = 10;
constexpr int kSamplePairsOfBoard = 50;

void check(const RectifyJob& job, const Settings& settings) {
  if (job.calibration.empty()) {
    settings.refuse_idle({"kitti-cameras", "lens"}, "without --calibration");
  }
  job.rectification.validate();
  job.common.execution.validate();
  job.input.validate();
  if (job.sample_pairs && (*job.sample_pairs < 1 || *job.sample_pairs > kMaxSamplePairs)) {
    throw UsageError(fmt::format("--sample-pairs is {}, expected a number from 1 to {}",
                                 *job.sample_pairs, kMaxSamplePairs));
  }
  if (job.board) {
    settings.refuse_idle({"calibration", "baseline"}, "with --board, which gives both");
  }
  require_above_0("baseline", job.baseline_m);
  if (job.output.empty() && job.matrices.empty() && job.valid_mask.empty()) {
    throw UsageError(
        "there is nothing to write, expected at least one of --output, --matrices and "
        "--valid-mask");
  }
  if (!job.matrices.empty() && !is_rectification_extension(job.matrices)) {
    throw UsageError(
        fmt::format("--matrices is '{}', expected a file name that ends in .yml .yaml .xml .json",
                    job.matrices));
  }
}

/// Checked before the pairs are opened, which may take time.
FileChecks check_files(const RectifyJob& job, const Settings& settings) {
  FileChecks files(settings);
  files.add_output(job.matrices, "--matrices", OutputKind::kText);
  files.add_output(job.valid_mask, "--valid-mask", OutputKind::kMask);
  check_common_files(job.common, files);
  return files;
}

void check_pairs(const PairSource& pairs, FileChecks& files) {
  for (const fs::path& file : pairs.files()) {
    files.add_input(file);
  }
}

/// The cameras that the board in these pairs shows.
BoardCalibration find_cameras(const CalibrationBoard& board, PairSource& pairs,
                              const std::vector<int>& sample, ImageSize size, Execution& execution,
                              RunReport& report) {
  std::vector<BoardPicture> pictures;
  for (const int index : sample) {
    pictures.push_back({.name = pairs.describe(index)});
  }
  for_each_sampled_pair(
      pairs, sample, size, execution, report, [&](std::size_t i, FramePair& pair) {
        pictures[i].seen = {find_board(pair.left, board), find_board(pair.right, board)};
      });
  return report.timed_compute(
      "estimate", [&] { return calibrate_with_board(board, std::move(pictures), size); });
}

void set_baseline(const RectifyJob& job, StereoCalibration& calibration) {
  if (job.baseline_m) {
    calibration.set_baseline_m(*job.baseline_m);
  }
}

/// Runs `work` and names the input in its errors.
template <typename Work>
auto about(const std::string& what, const Work& work) {
  try {
    return work();
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", what, error.what()));
  }
}

void rectify_pair(const Rectifier& rectifier, FramePair& pair, Execution& execution) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    Photograph& image = side == Side::kLeft ? pair.left : pair.right;
    Photograph result;
    rectifier.apply(image, side, result, execution);
    blacken_left_out(result);
    image = std::move(result);
  }
}

/// The pixels whose positions are inside both photographs.
Mask valid_mask(const Rectifier& rectifier) {
  const int width = rectifier.pair().width_px;
  const int height = rectifier.pair().height_px;
  const auto is_seen = [&](Side side, int x, int y) {
    const auto p = rectifier.source_position(side, {x, y});
    return p && p->x() >= -0.5 && p->x() <= width - 0.5 && p->y() >= -0.5 && p->y() <= height - 0.5;
  };
  Mask mask(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      mask.at(x, y) = is_seen(Side::kLeft, x, y) && is_seen(Side::kRight, x, y) ? 255 : 0;
    }
  }
  return mask;
}

/// Writes all pairs, rectified, until Ctrl-C.
void rectify_pairs(PairSource& pairs, const Rectifier& rectifier, RectifiedFiles& results,
                   bool is_quiet, Execution& execution, RunReport& report) {
  const std::atomic<bool>& interrupted = interrupt_flag();
  const int pair_count = pairs.pair_count();
  Progress progress("rectify", "pairs",
                    is_quiet || pair_count == 1 ? ProgressStyle::kNone : ProgressStyle::kAuto);
  FramePair pair;
  for (int index = 0; index < pair_count && !interrupted.load(); ++index) {
    report.timed_file_access("read", [&] { read_equal_pair(pairs, index, pair); });
    about(pairs.describe(index), [&] {
      report.timed_compute("remap", [&] { rectify_pair(rectifier, pair, execution); });
    });
    report.timed_file_access("write", [&] {
      results.write(Side::kLeft, pair);
      results.write(Side::kRight, pair);
    });
    progress.update(index + 1, pair_count, 0);
  }
}

}  // namespace

int run_rectify(RectifyJob& job, const Settings& settings) {
  check(job, settings);
  FileChecks files = check_files(job, settings);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;

  const std::unique_ptr<PairSource> pairs = open_pair_source(job.input);
  check_pairs(*pairs, files);
  tell_remarks(pairs->white_level().remarks, job.common, report);
  const int pair_count = pairs->pair_count();
  FramePair pair;
  report.timed_file_access("read", [&] { read_equal_pair(*pairs, 0, pair); });
  std::optional<RectifiedFiles> results;
  if (!job.output.empty()) {
    results.emplace(job.output, *pairs, pair);
    results->check(*pairs, files);
    files.require_nothing_made_unless(job.overwrite);
  }
  const ImageSize size = {pair.left.width(), pair.left.height()};
  const std::vector<int> sample = sampled_pairs(
      pair_count, job.sample_pairs.value_or(job.board ? kSamplePairsOfBoard : kSamplePairs));
  const std::string inputs = fmt::format("{} and {}", job.input.left, job.input.right);

  Rectification rectification;
  std::optional<BoardCalibration> board;
  if (job.board) {
    board = about(
        inputs, [&] { return find_cameras(*job.board, *pairs, sample, size, execution, report); });
    rectification.calibration = board->calibration;
  } else if (job.calibration.empty()) {
    rectification.matches =
        gather_matches(*pairs, sample, size, execution, report,
                       [](FramePair& one) { return match_features(one.left, one.right); });
    rectification.estimate = about(inputs, [&] {
      return report.timed_compute("estimate", [&] {
        return estimate_rig(rectification.matches, size.width_px, size.height_px);
      });
    });
    rectification.calibration = rectification.estimate->calibration;
  } else {
    choose_kitti_cameras(settings, job.common, job.calibration, pairs->files(),
                         job.calibration_choice);
    report.set_settings(settings.values());
    rectification.calibration = read_stereo_calibration(job.calibration, job.calibration_choice);
  }
  set_baseline(job, rectification.calibration);
  rectification.calibration = rectification.calibration.for_images(size.width_px, size.height_px);
  const auto rectifier_of_all = [&] {
    return report.timed_compute("maps", [&] {
      return Rectifier(rectification.calibration, size.width_px, size.height_px, job.rectification);
    });
  };
  // Errors of a calibration that was read already name its file.
  Rectifier rectifier =
      job.calibration.empty() ? about(inputs, rectifier_of_all) : rectifier_of_all();
  tell_remarks(rectifier.pair().remarks, job.common, report);
  // Squares of a board look alike: their features are mistaken for each other.
  const std::vector<PointMatch> found =
      board ? rectified_matches(board->matches, board->calibration, rectifier.pair())
            : gather_matches(*pairs, sample, size, execution, report, [&](FramePair& one) {
                rectify_pair(rectifier, one, execution);
                return match_features(one.left, one.right);
              });
  rectification.remaining = vertical_error(found);
  if (rectification.estimate) {
    report.timed_compute("estimate", [&] {
      improve_rectification(rectification, rectifier, found, job.rectification);
    });
    require_success(rectification, found.size(), inputs);
    report.timed_compute("validate", [&] {
      rectification.validation = validate_rig(*rectification.estimate, rectification.matches,
                                              size.width_px, size.height_px, job.rectification);
    });
  } else {
    rectification.matches = found;
  }

  report.timed_file_access("write", [&] {
    if (!job.matrices.empty()) {
      write_text_file(job.matrices, rectification_text(job.matrices, rectification.calibration,
                                                       rectifier.pair()));
    }
    if (!job.valid_mask.empty()) {
      write_mask(job.valid_mask, valid_mask(rectifier).view());
    }
  });
  const std::atomic<bool>& interrupted = interrupt_flag();
  if (results) {
    rectify_pairs(*pairs, rectifier, *results, job.common.quiet, execution, report);
  }
  SettingValue values = results_of(rectification, rectifier.pair(), pair_count);
  values["board"] = board ? board_values(*board) : SettingValue();
  report.set_results(std::move(values));
  report.write(job.common.report);
  if (!job.common.quiet) {
    for (const std::string& remark : pairs->remarks()) {
      tell("rectify: note: {}\n", with_dashes(remark));
    }
    if (board) {
      print_board(*board);
    }
    print_results(
        rectification, rectifier.pair(), pair_count,
        board ? fmt::format("{} pairs, corners off by {:.2f} px", board->pairs, board->rms_px)
              : job.calibration);
    report.print_summary();
  }
  return interrupted.load() ? kExitInterrupted : kExitDone;
}

}  // namespace vantage::apps
