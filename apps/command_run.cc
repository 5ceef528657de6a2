#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/automatic_disparities.h"
#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/option_groups.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "engine/error.h"
#include "engine/io/frame_source.h"
#include "engine/sequence/sequence_runner.h"
#include "engine/simd.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

struct RunJob {
  SequenceOptions sequence;
  CommonOptions common;
  std::string left;
  std::string right;
  std::string output;
  /// Empty: the disparity map, and the views when there are any.
  std::optional<std::vector<SequenceOutput>> save;
};

constexpr std::string_view kAutomatic = "auto";
constexpr std::pair<std::string_view, SequenceOutput> kOutputNames[] = {
    {"disparity", SequenceOutput::kDisparity},
    {"right-disparity", SequenceOutput::kRightDisparity},
    {"confidence", SequenceOutput::kConfidence},
    {"unmatched", SequenceOutput::kUnmatched},
    {"preview", SequenceOutput::kPreview},
    {"views", SequenceOutput::kViews}};

std::vector<SequenceOutput> to_outputs(const SettingValue& value) {
  std::vector<SequenceOutput> outputs;
  for (const SettingValue& member : to_list(value)) {
    for (const std::string& name : split(to_text(member), ',')) {
      const auto known = std::ranges::find(kOutputNames, name,
                                           &std::pair<std::string_view, SequenceOutput>::first);
      if (known == std::end(kOutputNames)) {
        reject_value(name,
                     "a list of disparity, right-disparity, confidence, unmatched, preview, views");
      }
      if (std::ranges::find(outputs, known->second) == outputs.end()) {
        outputs.push_back(known->second);
      }
    }
  }
  return outputs;
}

SettingValue output_names(const std::vector<SequenceOutput>& outputs) {
  SettingValue names = SettingValue::array();
  for (const SequenceOutput output : outputs) {
    names.push_back(std::ranges::find(kOutputNames, output,
                                      &std::pair<std::string_view, SequenceOutput>::second)
                        ->first);
  }
  return names;
}

void add_sequence_settings(Settings& settings, RunJob& job) {
  settings.begin_group("Files");
  settings
      .text("left", job.left, "SOURCE",
            "Frames of the left camera: a folder, a pattern (left/%06d.png), a glob or a video")
      .required = true;
  settings.text("right", job.right, "SOURCE", "Frames of the right camera").required = true;
  Setting& output = settings.text("output", job.output, "DIR",
                                  "Folder to write to: DIR/disparity/000000.pfm and so on");
  output.short_name = 'o';
  output.required = true;
  settings.begin_group("Sequence");
  Setting& save =
      settings.add("save", "LIST",
                   "What to write of each frame, from disparity,right-disparity,confidence,"
                   "unmatched,preview,views; auto: disparity, and views if there are any");
  save.list = true;
  save.set = [&job](const SettingValue& value) {
    const auto members = to_list(value);
    if (members.size() == 1 && members.front() == kAutomatic) {
      job.save.reset();
    } else {
      job.save = to_outputs(value);
    }
  };
  save.get = [&job] { return job.save ? output_names(*job.save) : SettingValue(kAutomatic); };
  add_view_setting(settings, job.sequence.views_x);
  settings.text("format", job.sequence.disparity_format, "EXT",
                "File format of the maps: pfm, png, tiff, exr or npy");
  settings.integer("in-flight", job.sequence.in_flight, "N",
                   "Frames under way at once, 1 to 64; auto: threads + 1, at most 8");
}

fs::path resolved(const fs::path& path) {
  std::error_code ignored;
  return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
}

/// Results must not land among the frames they are made from.
void require_separate_folders(const RunJob& job) {
  for (const std::string& source : {job.left, job.right}) {
    std::error_code ignored;
    const fs::path folder =
        fs::is_directory(source, ignored) ? fs::path(source) : fs::path(source).parent_path();
    for (const fs::path& written : SequenceLayout(job.output, job.sequence).folders()) {
      if (resolved(written) == resolved(folder)) {
        throw UsageError(fmt::format("--output would write into '{}', where the frames '{}' are",
                                     written.string(), source));
      }
    }
  }
}

void check(const RunJob& job) {
  job.sequence.validate();
  job.common.execution.validate();
  require_separate_folders(job);
  FileChecks files;
  files.add_output(job.common.report, "--report", OutputKind::kText);
}

/// Opens the sources once more: a frame that has been read from them is gone.
void choose_disparities_of_first_pair(RunJob& job, const Settings& settings, Execution& execution,
                                      RunReport& report) {
  if (!job.sequence.match.disparities_auto) {
    return;
  }
  Photograph left;
  Photograph right;
  const auto read_first = [&](const std::string& source, Photograph& frame) {
    if (!open_frame_source(source)->next(frame)) {
      throw Error(fmt::format("{} has no frame", source));
    }
  };
  report.timed_file_access("read", [&] {
    read_first(job.left, left);
    read_first(job.right, right);
  });
  choose_disparities(settings, job.common, left, right, job.sequence.match, execution, report);
}

void fill_report(const SequenceReport& sequence, RunReport& report) {
  for (const SequenceStage& stage : sequence.stages) {
    report.add_stage(stage.name, stage.seconds);
  }
  report.add_compute_seconds(sequence.compute_seconds);
  report.add_cells(sequence.cells);
  report.set_plan(sequence.plan);
  report.set_results({{"frames", sequence.frames},
                      {"interrupted", sequence.interrupted},
                      {"in_flight", sequence.in_flight},
                      {"width_px", sequence.width_px},
                      {"height_px", sequence.height_px}});
}

}  // namespace

int command_run(const Arguments& arguments) {
  RunJob job;
  Settings settings("run",
                    "Computes disparity maps and new views of a sequence of rectified pairs.");
  add_sequence_settings(settings, job);
  add_reference_setting(settings, job.sequence.match);
  add_match_settings(settings, job.sequence.match);
  add_synthesis_settings(settings, job.sequence.synthesis);
  add_common_settings(settings, job.common);
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  if (job.save) {
    job.sequence.save = *job.save;
  } else if (!job.sequence.views_x.empty()) {
    job.sequence.save.push_back(SequenceOutput::kViews);
  }
  check(job);
  RunReport report(settings.command(), reported_settings(settings, job.sequence.match));
  force_instruction_set(job.common.isa);
  Execution execution(job.common.execution);
  report.set_execution(execution);
  choose_disparities_of_first_pair(job, settings, execution, report);
  const SequenceRunner runner(job.sequence, execution);
  const std::unique_ptr<FrameSource> left = open_frame_source(job.left);
  const std::unique_ptr<FrameSource> right = open_frame_source(job.right);

  SequenceReport sequence;
  {
    Progress progress("run", "frames", job.common.quiet);
    sequence = runner.run(
        *left, *right, job.output,
        [&](const SequenceProgress& now) {
          progress.update(now.frames_done, now.frames_total, now.cells);
        },
        &interrupt_flag());
  }
  fill_report(sequence, report);
  report.write(job.common.report);
  if (!job.common.quiet) {
    fmt::print(stderr, "run: {} frames of {}x{} pixels, {} in flight -> {}{}\n", sequence.frames,
               sequence.width_px, sequence.height_px, sequence.in_flight, job.output,
               sequence.interrupted ? " (interrupted)" : "");
    report.print_summary();
  }
  return sequence.interrupted ? kExitInterrupted : kExitDone;
}

}  // namespace vantage::apps
