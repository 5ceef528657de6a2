#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/commands.h"
#include "apps/frame_rate_setting.h"
#include "apps/interrupt.h"
#include "apps/option_groups.h"
#include "apps/outputs.h"
#include "apps/pair_input.h"
#include "apps/progress.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "apps/view_output.h"
#include "apps/view_renderer.h"
#include "apps/wanted_views.h"
#include "engine/error.h"
#include "engine/image/stereo_display.h"
#include "engine/sequence/busy_clock.h"
#include "engine/simd.h"
#include "engine/view_geometry/view_pose.h"
#include "scheduler/frame_pipeline.h"

namespace vantage::apps {
namespace {

struct SynthJob {
  PairInput pair;
  SynthesisOptions synthesis;
  CommonOptions common;
  std::string output;
  WantedViews views;
  std::optional<StereoDisplay> stereo_packing;
  double eye_separation_baselines = 1;
  std::string hole_mask;
  std::string source_mask;
  FrameRate frame_rate;
};

/// A mask that is written beside the views.
struct MaskOutput {
  const char* option;
  Mask SynthesizedView::*mask;
  ViewOutput output;
};

std::vector<MaskOutput> masks_of(const SynthJob& job, int views) {
  std::vector<MaskOutput> masks;
  if (!job.hole_mask.empty()) {
    masks.push_back({"--hole-mask", &SynthesizedView::holes, ViewOutput(job.hole_mask, views)});
  }
  if (!job.source_mask.empty()) {
    masks.push_back(
        {"--source-mask", &SynthesizedView::sources, ViewOutput(job.source_mask, views)});
  }
  return masks;
}

void add_view_settings(Settings& settings, SynthJob& job) {
  settings.begin_group("Views");
  add_wanted_views(settings, job.views);
  settings.choice<StereoDisplay>("stereo-packing", job.stereo_packing, stereo_display_names(),
                                 "Two eyes for every view, in one picture: side by side, one above "
                                 "the other, interleaved or as an anaglyph",
                                 "none");
  settings.number("eye-separation", job.eye_separation_baselines, "S",
                  "Distance of the two eyes in baselines, the view in their middle");
  add_frame_rate_setting(settings, "fps", job.frame_rate, "Views per second of a video");
}

void add_file_settings(Settings& settings, SynthJob& job) {
  settings.begin_group("Files");
  add_pair_settings(settings, job.pair);
  add_view_output_settings(settings, job.output, job.hole_mask);
  settings.text("source-mask", job.source_mask, "MASK.png",
                "Write which images the pixels are made of: 0 none, 85 left, 170 right, 255 both");
}

void check(const SynthJob& job, const Settings& settings, const ViewOutput& output,
           const std::vector<MaskOutput>& masks) {
  job.synthesis.validate();
  job.common.execution.validate();
  constexpr double kLargestSeparation = 16;
  if (!(job.eye_separation_baselines > 0 && job.eye_separation_baselines <= kLargestSeparation)) {
    throw UsageError(fmt::format("--eye-separation is {}, expected more than 0, at most {}",
                                 job.eye_separation_baselines, kLargestSeparation));
  }
  if (job.stereo_packing && !masks.empty()) {
    throw UsageError(
        fmt::format("{} is the mask of one view, expected no --stereo-packing", masks[0].option));
  }
  if (!job.stereo_packing && settings.given_on_command_line("eye-separation")) {
    throw UsageError("--eye-separation has no effect without --stereo-packing");
  }
  FileChecks files;
  check_pair(job.pair, settings, files);
  output.check(files, "--output");
  for (const MaskOutput& mask : masks) {
    mask.output.check(files, mask.option);
  }
  files.add_output(job.common.report, "--report", OutputKind::kText);
}

SettingValue rows_of(const Eigen::Matrix3d& matrix) {
  SettingValue rows = SettingValue::array();
  for (int row = 0; row < 3; ++row) {
    rows.push_back({matrix(row, 0), matrix(row, 1), matrix(row, 2)});
  }
  return rows;
}

SettingValue describe(const ViewPose& pose, const SynthesizedView& view) {
  SettingValue entry = SettingValue::object();
  if (const auto* camera = std::get_if<PosedCamera>(&pose)) {
    const Eigen::Vector3d& t = camera->translation;
    entry["K"] = rows_of(camera->matrix);
    entry["R"] = rows_of(camera->rotation);
    entry["t"] = {t.x(), t.y(), t.z()};
  } else {
    entry["view_x"] = std::get<BaselinePosition>(pose).x;
    entry["view_y"] = std::get<BaselinePosition>(pose).y;
  }
  entry["hole_fraction"] = view.hole_fraction;
  SettingValue fits = SettingValue::array();
  const int channels = std::min(view.image.channels(), static_cast<int>(view.intensity.size()));
  for (int channel = 0; channel < channels; ++channel) {
    const IntensityFit& fit = view.intensity[static_cast<std::size_t>(channel)];
    fits.push_back({{"offset", fit.offset}, {"gain", fit.gain}});
  }
  entry["intensity"] = fits;
  return entry;
}

/// Renders and delivers all views, several at a time; false when interrupted.
class Rendering {
 public:
  Rendering(const SynthJob& job, const std::vector<ViewPose>& poses, const ViewRenderer& renderer,
            ViewOutput& output, std::vector<MaskOutput>& masks)
      : job_(job), poses_(poses), renderer_(renderer), output_(output), masks_(masks) {}

  bool run(Execution& execution, RunReport& report) {
    // Two more than threads: one being encoded, one waiting for it.
    const int in_flight =
        std::min(execution.executor().thread_count() + 2, static_cast<int>(poses_.size()));
    slots_.resize(static_cast<std::size_t>(in_flight));
    Progress progress(
        "synth", "views",
        job_.common.quiet || poses_.size() == 1 ? ProgressStyle::kNone : ProgressStyle::kAuto);
    scheduler::FrameSteps steps;
    steps.read = [&](int slot) {
      slot_of(slot).index = next_++;
      return slot_of(slot).index < static_cast<int>(poses_.size());
    };
    steps.prepare = [](int /*slot*/) {};
    steps.compute = [&](int slot) {
      const BusyClock::Activity activity(computing_);
      renderer_.render(pose_of(slot_of(slot)), slot_of(slot).view);
    };
    steps.encode = [&](int slot) { write(slot_of(slot), /*in_order=*/false); };
    steps.write = [&](int slot) {
      write(slot_of(slot), /*in_order=*/true);
      report.add_stage("views", slot_of(slot).view.seconds);
      report.add_stage("write", std::exchange(slot_of(slot).write_seconds, 0));
      results_.push_back(describe(pose_of(slot_of(slot)), slot_of(slot).view.eyes[0]));
      progress.update(static_cast<int>(results_.size()), static_cast<int>(poses_.size()), 0);
    };
    const scheduler::FrameOutcome outcome =
        scheduler::run_frames(execution.executor(), in_flight, steps, {}, &interrupt_flag());
    report.add_compute_seconds(computing_.seconds());
    return !outcome.interrupted;
  }

  [[nodiscard]] const SettingValue& results() const { return results_; }

 private:
  struct Slot {
    int index = 0;
    RenderedView view;
    double write_seconds = 0;
  };

  [[nodiscard]] Slot& slot_of(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  [[nodiscard]] const ViewPose& pose_of(const Slot& slot) const {
    return poses_[static_cast<std::size_t>(slot.index)];
  }

  // Images are files of their own, frames of a video follow each other.
  void write(Slot& slot, bool in_order) {
    const auto start = std::chrono::steady_clock::now();
    if (output_.needs_order() == in_order) {
      output_.write(slot.index, slot.view.picture(job_.stereo_packing.has_value()),
                    job_.frame_rate);
    }
    for (MaskOutput& mask : masks_) {
      if (mask.output.needs_order() == in_order) {
        mask.output.write(slot.index, {(slot.view.eyes[0].*mask.mask).copy()}, job_.frame_rate);
      }
    }
    slot.write_seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  const SynthJob& job_;
  const std::vector<ViewPose>& poses_;
  const ViewRenderer& renderer_;
  ViewOutput& output_;
  std::vector<MaskOutput>& masks_;
  std::vector<Slot> slots_;
  int next_ = 0;
  BusyClock computing_;
  SettingValue results_ = SettingValue::array();
};

}  // namespace

int command_synth(const Arguments& arguments) {
  SynthJob job;
  Settings settings("synth", "Renders new views of a stereo pair: stills, or movies along a path.");
  add_file_settings(settings, job);
  add_view_settings(settings, job);
  add_synthesis_settings(settings, job.synthesis);
  add_match_settings(settings, job.pair.match);
  add_common_settings(settings, job.common);
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  std::vector<ViewPose> poses = poses_of(job.views);
  const int views = static_cast<int>(poses.size());
  ViewOutput output(job.output, views);
  std::vector<MaskOutput> masks = masks_of(job, views);
  check(job, settings, output, masks);
  RunReport report(settings.command(), reported_settings(settings, job.pair));
  force_instruction_set(job.common.isa);
  Execution execution(job.common.execution);
  report.set_execution(execution);
  const PairWithMaps input = read_pair(job.pair, settings, job.common, execution, report);
  complete_poses(job.views, input.cameras ? &*input.cameras : nullptr, input.left.width(),
                 input.left.height(), poses);
  std::optional<TwoEyes> two_eyes;
  if (job.stereo_packing) {
    two_eyes = {*job.stereo_packing, job.eye_separation_baselines};
  }
  ViewRenderer renderer(input, job.synthesis, two_eyes, execution);
  if (views > 1) {
    report.timed_compute("views", [&] { renderer.fix_intensities(); });
  }
  Rendering rendering(job, poses, renderer, output, masks);
  if (!rendering.run(execution, report)) {
    if (!job.common.quiet) {
      fmt::print(stderr, "synth: interrupted after {} of {} views\n", rendering.results().size(),
                 views);
    }
    return kExitInterrupted;
  }
  report.timed_file_access("write", [&] {
    output.finish();
    for (MaskOutput& mask : masks) {
      mask.output.finish();
    }
  });

  report.set_results({{"views", rendering.results()}});
  report.write(job.common.report);
  if (!job.common.quiet) {
    fmt::print(stderr, "synth: {}x{} pixels, {} view{} -> {}\n", input.left.width(),
               input.left.height(), views, views == 1 ? "" : "s", job.output);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
