#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/input_limits.h"
#include "apps/option_groups.h"
#include "apps/outputs.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "apps/tell.h"
#include "apps/view_output.h"
#include "apps/view_pipeline.h"
#include "apps/wanted_scene_views.h"
#include "engine/scene_graph/scene_viewer.h"
#include "engine/scene_graph/stored_scene.h"
#include "engine/simd.h"

namespace vantage::apps {
namespace {

struct SceneViewJob {
  std::string scene;
  WantedSceneViews views;
  ViewOutputOptions output;
  SynthesisOptions synthesis;
  CommonOptions common;
};

void add_settings(Settings& settings, SceneViewJob& job) {
  settings.start_group("Files");
  settings.positional("scene", job.scene, "Folder made by 'vantage scene build'").required = true;
  add_view_file_settings(settings, job.output);

  settings.start_group("Views");
  add_wanted_scene_views(settings, job.views);
  add_view_display_settings(settings, job.output, "lengths of the scene's shortest edge");

  settings.start_group("View synthesis");
  add_holes_setting(settings, job.synthesis.holes);
  add_soft_edges_setting(settings, job.synthesis.soft_edges);
  add_surface_settings(settings, job.synthesis);
}

void check(const SceneViewJob& job, const Settings& settings, const StoredScene& scene,
           const ViewOutputs& outputs) {
  FileChecks files(settings);
  for (const std::filesystem::path& file : scene.files()) {
    files.add_input(std::filesystem::path(job.scene) / file);
  }
  outputs.check(files);
  check_common_files(job.common, files);
}

SettingValue describe_view(const PreparedSceneView& prepared, const SynthesizedView& view) {
  const ScenePlace& place = prepared.place;
  SettingValue sources = SettingValue::array();
  for (int k = 0; k < place.count; ++k) {
    const auto number = static_cast<std::size_t>(k);
    sources.push_back({{"image", place.vertices[number]}, {"weight", place.weights[number]}});
  }
  return {{"x", prepared.position.x},
          {"y", prepared.position.y},
          {"from", sources},
          {"is_outside", place.is_outside},
          {"hole_fraction", view.hole_fraction}};
}

/// Positions of the eyes of a view: one, or two with the view at their midpoint.
std::vector<ScenePosition> eyes_of(const SceneViewJob& job, ScenePosition view,
                                   double unit_length) {
  if (!job.output.stereo_packing) {
    return {view};
  }
  const double half = job.output.eye_separation * unit_length / 2;
  return {{view.x - half, view.y}, {view.x + half, view.y}};
}

}  // namespace

int command_scene_view(const Arguments& arguments) {
  SceneViewJob job;
  Settings settings("scene view", "Renders new views between the images of a scene.");
  add_settings(settings, job);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"scene", "output", "at", "sweep", "path", "stereo-packing", "fps", "holes", "threads",
       "quiet"},
      {"vantage scene view scene --at 0.25,0 -o between.png",
       "vantage scene view scene --sweep 0,0:0.6,0:60 -o along.mp4",
       "vantage scene view scene --at 0.25,0 --stereo-packing arcd -o anaglyph.png"});
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  const std::vector<ScenePosition> positions = scene_positions_of(job.views);
  const int views = static_cast<int>(positions.size());
  ViewOutputs outputs(job.output, settings, views);
  job.synthesis.validate();
  job.common.execution.validate();
  const StoredScene scene = read_scene(job.scene);
  check(job, settings, scene, outputs);
  const SceneLayout layout(scene.positions(), scene.names());
  require_complete(scene, layout, job.scene);

  RunReport report(settings.command(), settings.values());
  report.start_trace(job.common.trace);
  force_instruction_set(job.common.isa);
  Execution execution(job.common.execution);
  report.set_execution(execution);
  SceneViewer viewer(
      layout, [&](int vertex) { return load_vertex(job.scene, scene, vertex); }, job.synthesis,
      execution);
  std::vector<std::vector<ScenePosition>> eyes;
  for (const ScenePosition position : positions) {
    eyes.push_back(eyes_of(job, position, layout.unit_length()));
    for (const ScenePosition eye : eyes.back()) {
      viewer.require_near(eye);  // before any of them is rendered
    }
  }

  std::vector<std::array<PreparedSceneView, 2>> prepared(
      static_cast<std::size_t>(views_in_flight(execution, views)));
  const auto for_each_eye = [&](int slot, int view, const auto& body) {
    const std::vector<ScenePosition>& of_view = eyes[static_cast<std::size_t>(view)];
    for (std::size_t eye = 0; eye < of_view.size(); ++eye) {
      body(of_view[eye], prepared[static_cast<std::size_t>(slot)][eye], eye);
    }
  };
  int outside = 0;
  ViewSteps steps;
  steps.read = [&](int slot, int view) {
    for_each_eye(slot, view, [&](ScenePosition eye, auto& /*prepared*/, std::size_t /*number*/) {
      viewer.load(eye);
    });
  };
  steps.prepare = [&](int slot, int view) {
    for_each_eye(slot, view, [&](ScenePosition eye, PreparedSceneView& of_eye, std::size_t) {
      of_eye = viewer.prepare(eye);
    });
  };
  steps.render = [&](int slot, int view, RenderedView& result) {
    for_each_eye(slot, view,
                 [&](ScenePosition /*eye*/, const PreparedSceneView& of_eye, std::size_t number) {
                   viewer.render(of_eye, result.eyes[number]);
                 });
    if (job.output.stereo_packing) {
      show_stereo(result.eyes[0].image, result.eyes[1].image, *job.output.stereo_packing,
                  result.both);
    }
  };
  steps.describe = [&](int slot, int view, const RenderedView& result) {
    SettingValue described = SettingValue::array();
    bool is_outside = false;
    for_each_eye(slot, view,
                 [&](ScenePosition /*eye*/, const PreparedSceneView& of_eye, std::size_t number) {
                   described.push_back(describe_view(of_eye, result.eyes[number]));
                   is_outside = is_outside || of_eye.place.is_outside;
                 });
    outside += is_outside ? 1 : 0;
    return described.size() == 1 ? described[0] : SettingValue{{"eyes", described}};
  };
  const ViewPipelineResult rendered =
      render_views(settings.command(), views, steps, job.output.stereo_packing.has_value(), outputs,
                   job.common, execution, report);
  if (rendered.interrupted) {
    return kExitInterrupted;
  }
  report.set_results({{"views", rendered.views}, {"views_outside", outside}});
  report.write(job.common.report);
  if (!job.common.quiet) {
    if (outside > 0) {
      tell(
          "scene view: {} of {} view{} outside the area of the images, rendered from the nearest "
          "edge\n",
          outside, views, views == 1 ? " is" : "s are");
    }
    tell("scene view: {}x{} pixels, {} view{} -> {}\n", rendered.width_px, rendered.height_px,
         views, views == 1 ? "" : "s", job.output.output);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
