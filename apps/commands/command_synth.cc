#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/inputs/pair_input.h"
#include "apps/match/empty_views.h"
#include "apps/match/view_output.h"
#include "apps/match/view_pipeline.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "apps/settings/toml_file.h"
#include "engine/image/memory_use.h"
#include "engine/options/matrix_rows.h"
#include "engine/options/settings.h"
#include "engine/options/synthesis_settings.h"
#include "engine/options/wanted_views.h"
#include "engine/synthesis/view_renderer.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage::apps {
namespace {

struct SynthJob {
  PairInput pair;
  SynthesisOptions synthesis;
  CommonOptions common;
  ViewOutputOptions output;
  WantedViews views;
};

void add_view_settings(Settings& settings, SynthJob& job) {
  settings.start_group("Views");
  add_wanted_views(settings, job.views);
  add_view_display_settings(settings, job.output, "baselines");
}

void add_file_settings(Settings& settings, SynthJob& job) {
  settings.start_group("Files");
  add_pair_settings(settings, job.pair);
  add_view_file_settings(settings, job.output);
}

void check(const SynthJob& job, const Settings& settings, const ViewOutputs& outputs) {
  job.synthesis.validate();
  check_combining(settings, job.synthesis);
  job.common.execution.validate();
  check_pair(job.pair, settings);
  FileChecks files(settings);
  outputs.check(files);
  check_common_files(job.common, files);
}

SettingValue describe_posed_view(const ViewPose& pose, const SynthesizedView& view) {
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

/// Memory of the pair; memory of rendering is not listed.
MemoryUse memory_use(const PairWithMaps& input, Execution& execution) {
  MemoryUse use;
  use.add("photographs", held_bytes(input.left) + held_bytes(input.right));
  if (input.unrectified) {
    use.add("photographs",
            held_bytes(input.unrectified->left) + held_bytes(input.unrectified->right));
  }
  use.add("maps", held_bytes(input.maps));
  add_scratch_use(execution, use);
  return use;
}

}  // namespace

int command_synth(const Arguments& arguments) {
  SynthJob job;
  Settings settings("synth",
                    "Renders new views of a stereo pair: images, or a video along a path.");
  add_file_settings(settings, job);
  add_view_settings(settings, job);
  add_synthesis_settings(settings, job.synthesis);
  add_match_settings(settings, job.pair.match);
  add_common_settings(settings, job.common);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "calibration", "output", "view", "sweep", "orbit", "path", "fps", "holes",
       "disparities", "preset", "threads", "quiet"},
      {"vantage synth left.png right.png --view 0.5 -o between.png",
       "vantage synth left.png right.png --sweep 0:1:50 -o sweep.mp4",
       "vantage synth left.png right.png --calibration calib.txt --orbit 0.3:60 -o orbit.mp4"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  std::vector<ViewPose> poses = poses_of(job.views, read_toml_document);
  const int views = static_cast<int>(poses.size());
  ViewOutputs outputs(job.output, settings, views);
  check(job, settings, outputs);
  CommandWork work(settings, job.common, reported_settings(settings, job.pair));
  RunReport& report = work.report;
  Execution& execution = work.execution;
  const PairWithMaps input = read_pair(job.pair, settings, job.common, execution, report);
  complete_poses(job.views, input.cameras ? &*input.cameras : nullptr, input.left.width(),
                 input.left.height(), poses);
  std::optional<TwoEyes> two_eyes;
  if (job.output.stereo_packing) {
    two_eyes = {*job.output.stereo_packing, job.output.eye_separation};
  }
  ViewRenderer renderer(input, job.synthesis, two_eyes, execution);
  renderer.check(poses);
  if (views > 1) {
    report.timed_compute("views", [&] { renderer.fix_intensities(); });
  }
  const auto pose_of = [&](int view) -> const ViewPose& {
    return poses[static_cast<std::size_t>(view)];
  };
  ViewSteps steps;
  steps.render = [&](int /*slot*/, int view, RenderedView& result) {
    renderer.render(pose_of(view), result);
  };
  steps.describe = [&](int /*slot*/, int view, const RenderedView& result) {
    return describe_posed_view(pose_of(view), result.eyes[0]);
  };
  const ViewPipelineResult rendered =
      render_views(settings.command(), views, steps, two_eyes.has_value(), outputs, job.common,
                   execution, report);
  if (rendered.interrupted) {
    return kExitInterrupted;
  }
  if (!job.common.quiet) {
    std::vector<int> empty_views;
    for (int view = 0; view < views; ++view) {
      if (rendered.views[static_cast<std::size_t>(view)]["hole_fraction"] == 1.0) {
        empty_views.push_back(view);
      }
    }
    warn_of_empty_views(settings.command(), input, poses, empty_views);
  }
  report.set_memory(memory_use(input, execution));
  return work.finish(
      {{"views", rendered.views}},
      fmt::format("{}x{} pixels, {} view{} -> {}", rendered.width_px, rendered.height_px, views,
                  views == 1 ? "" : "s", job.output.output));
}

}  // namespace vantage::apps
