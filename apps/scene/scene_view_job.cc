#include "apps/scene/scene_view_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/match/view_pipeline.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "engine/error.h"
#include "engine/scene_graph/posed_viewer.h"
#include "engine/scene_graph/scene_viewer.h"
#include "engine/scene_graph/stored_scene.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage::apps {
namespace {

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

SettingValue describe_view(const PreparedPosedView& prepared, const SynthesizedView& view) {
  SettingValue sources = SettingValue::array();
  for (const PreparedPosedView::Source& source : prepared.sources) {
    sources.push_back({{"image", source.vertex}, {"share", source.share}});
  }
  const Eigen::Vector3d centre = prepared.camera.centre();
  return {{"centre", {centre.x(), centre.y(), centre.z()}},
          {"from", sources},
          {"hole_fraction", view.hole_fraction}};
}

bool is_outside(const PreparedSceneView& prepared) { return prepared.place.is_outside; }
bool is_outside(const PreparedPosedView& /*prepared*/) { return false; }

ScenePosition moved_to_the_right(ScenePosition view, double distance) {
  return {view.x + distance, view.y};
}
PosedCamera moved_to_the_right(const PosedCamera& view, double distance) {
  return std::get<PosedCamera>(moved_right(view, 1, distance));
}

/// Positions or cameras of the eyes of a view: one, or two with the view at their midpoint.
template <typename Eye>
std::vector<Eye> eyes_of(const SceneViewJob& job, const Eye& view, double unit_length) {
  if (!job.output.stereo_packing) {
    return {view};
  }
  const double half = job.output.eye_separation * unit_length / 2;
  return {moved_to_the_right(view, -half), moved_to_the_right(view, half)};
}

/// What a command has when its scene is read.
struct OpenScene {
  const SceneViewJob& job;
  ViewOutputs& outputs;
  Execution& execution;
  RunReport& report;
  std::string command;
};

/// Renders and writes the views, which `viewer` makes from Eye: a position or a camera.
template <typename Viewer, typename Eye>
int render(OpenScene& open, Viewer& viewer, const std::vector<Eye>& wanted, double unit_length) {
  const SceneViewJob& job = open.job;
  const int views = static_cast<int>(wanted.size());
  std::vector<std::vector<Eye>> eyes;
  for (const Eye& view : wanted) {
    eyes.push_back(eyes_of(job, view, unit_length));
    for (const Eye& eye : eyes.back()) {
      viewer.require_near(eye);  // before any of them is rendered
    }
  }
  using Prepared = decltype(viewer.prepare(wanted.front()));
  std::vector<std::array<Prepared, 2>> prepared(
      static_cast<std::size_t>(views_in_flight(open.execution, views)));
  const auto for_each_eye = [&](int slot, int view, const auto& body) {
    const std::vector<Eye>& of_view = eyes[static_cast<std::size_t>(view)];
    for (std::size_t eye = 0; eye < of_view.size(); ++eye) {
      body(of_view[eye], prepared[static_cast<std::size_t>(slot)][eye], eye);
    }
  };
  int outside = 0;
  ViewSteps steps;
  steps.read = [&](int slot, int view) {
    for_each_eye(slot, view, [&](const Eye& eye, auto& /*prepared*/, std::size_t /*number*/) {
      viewer.load(eye);
    });
  };
  steps.prepare = [&](int slot, int view) {
    for_each_eye(slot, view, [&](const Eye& eye, Prepared& of_eye, std::size_t /*number*/) {
      of_eye = viewer.prepare(eye);
    });
  };
  steps.render = [&](int slot, int view, RenderedView& result) {
    for_each_eye(slot, view, [&](const Eye& /*eye*/, const Prepared& of_eye, std::size_t number) {
      viewer.render(of_eye, result.eyes[number]);
    });
    if (job.output.stereo_packing) {
      show_stereo(result.eyes[0].image, result.eyes[1].image, *job.output.stereo_packing,
                  result.both);
    }
  };
  steps.describe = [&](int slot, int view, const RenderedView& result) {
    SettingValue described = SettingValue::array();
    bool one_is_outside = false;
    for_each_eye(slot, view, [&](const Eye& /*eye*/, const Prepared& of_eye, std::size_t number) {
      described.push_back(describe_view(of_eye, result.eyes[number]));
      one_is_outside = one_is_outside || is_outside(of_eye);
    });
    outside += one_is_outside ? 1 : 0;
    return described.size() == 1 ? described[0] : SettingValue{{"eyes", described}};
  };
  const ViewPipelineResult rendered =
      render_views(open.command, views, steps, job.output.stereo_packing.has_value(), open.outputs,
                   job.common, open.execution, open.report);
  if (rendered.interrupted) {
    return kExitInterrupted;
  }
  open.report.set_results({{"views", rendered.views}, {"views_outside", outside}});
  open.report.write(job.common.report);
  if (!job.common.quiet) {
    if (outside > 0) {
      tell(
          "scene view: {} of {} view{} outside the area of the images, rendered from the nearest "
          "edge\n",
          outside, views, views == 1 ? " is" : "s are");
    }
    tell("scene view: {}x{} pixels, {} view{} -> {}\n", rendered.width_px, rendered.height_px,
         views, views == 1 ? "" : "s", job.output.output);
    open.report.print_summary();
  }
  return kExitDone;
}

std::vector<PosedCamera> cameras_of(const StoredScene& scene) {
  std::vector<PosedCamera> cameras;
  for (const SceneCamera& camera : scene.cameras()) {
    cameras.push_back({.matrix = camera.lens.matrix,
                       .rotation = camera.pose.rotation,
                       .translation = camera.pose.translation,
                       .width_px = scene.width_px,
                       .height_px = scene.height_px});
  }
  return cameras;
}

void require_one_size(const std::vector<PosedCamera>& views) {
  for (const PosedCamera& view : views) {
    if (view.width_px != views[0].width_px || view.height_px != views[0].height_px) {
      throw UsageError(fmt::format("views are {}x{} and {}x{}, expected one size",
                                   views[0].width_px, views[0].height_px, view.width_px,
                                   view.height_px));
    }
  }
}

}  // namespace

int run_scene_view(const SceneViewJob& job, const Settings& settings) {
  job.synthesis.validate();
  job.common.execution.validate();
  const StoredScene scene = read_scene(job.scene);
  std::vector<ScenePosition> positions;
  std::vector<PosedCamera> cameras;
  if (scene.is_posed()) {
    cameras = scene_cameras_of(job.views, cameras_of(scene));
    require_one_size(cameras);
  } else {
    settings.refuse_idle({"sources"}, "for a scene without poses");
    positions = scene_positions_of(job.views);
  }
  ViewOutputs outputs(job.output, settings, static_cast<int>(positions.size() + cameras.size()));
  check(job, settings, scene, outputs);

  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;
  OpenScene open{job, outputs, execution, report, settings.command()};
  const auto load = [&](int vertex) { return load_vertex(job.scene, scene, vertex, execution); };
  if (scene.is_posed()) {
    require_complete(scene, scene.graph, job.scene);
    PosedViewer viewer(scene, load, job.synthesis, job.sources, execution);
    return render(open, viewer, cameras, viewer.unit_length());
  }
  const SceneLayout layout(scene.positions(), scene.names());
  require_complete(scene, layout.edges(), job.scene);
  SceneViewer viewer(layout, load, job.synthesis, execution);
  return render(open, viewer, positions, layout.unit_length());
}

}  // namespace vantage::apps
