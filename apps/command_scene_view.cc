#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/commands.h"
#include "apps/frame_rate_setting.h"
#include "apps/interrupt.h"
#include "apps/option_groups.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/run_report.h"
#include "apps/scene_images.h"
#include "apps/settings.h"
#include "apps/view_output.h"
#include "engine/error.h"
#include "engine/scene_graph/scene_viewer.h"
#include "engine/scene_graph/stored_scene.h"
#include "engine/simd.h"

namespace vantage::apps {
namespace {

constexpr int kMostViews = 10000;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Views at equal steps from one position to another, both included.
struct SceneSweep {
  ScenePosition first;
  ScenePosition last;
  int views = 0;
};

struct SceneViewJob {
  std::string scene;
  std::vector<ScenePosition> at;
  std::optional<SceneSweep> sweep;
  SynthesisOptions synthesis;
  CommonOptions common;
  std::string output;
  std::string hole_mask;
  FrameRate frame_rate;
};

std::string to_text(ScenePosition position) { return fmt::format("{},{}", position.x, position.y); }

SceneSweep to_sweep(const SettingValue& value) {
  const auto parts = split(value.is_string() ? value.get<std::string>() : "", ':');
  try {
    if (parts.size() == 3) {
      const SceneSweep sweep{to_scene_position(parts[0]), to_scene_position(parts[1]),
                             to_integer(parts[2])};
      if (sweep.views >= 2 && sweep.views <= kMostViews) {
        return sweep;
      }
    }
  } catch (const UsageError&) {  // the message below says more
  }
  reject_value(value,
               fmt::format("X0,Y0:X1,Y1:VIEWS with 2 to {} views, such as 0,0:2,1:50", kMostViews));
}

void add_settings(Settings& settings, SceneViewJob& job) {
  settings.begin_group("Files");
  settings.positional("scene", job.scene, "Folder made by 'vantage scene build'").required = true;
  add_view_output_settings(settings, job.output, job.hole_mask);

  settings.begin_group("Views");
  Setting& at = settings.add("at", "X,Y",
                             "Position of a new view, in the unit of the images' positions; "
                             "repeatable");
  at.list = true;
  at.set = [&job](const SettingValue& value) {
    std::vector<ScenePosition> positions;
    for (const SettingValue& member : to_list(value)) {
      positions.push_back(to_scene_position(member));
    }
    job.at = std::move(positions);
  };
  at.get = [&job] {
    SettingValue values = SettingValue::array();
    for (const ScenePosition position : job.at) {
      values.push_back(to_text(position));
    }
    return values;
  };
  Setting& sweep =
      settings.add("sweep", "A:B:N", "N views at equal steps from position A to position B");
  sweep.set = [&job](const SettingValue& value) { job.sweep = to_sweep(value); };
  sweep.get = [&job]() -> SettingValue {
    return job.sweep ? SettingValue(fmt::format("{}:{}:{}", to_text(job.sweep->first),
                                                to_text(job.sweep->last), job.sweep->views))
                     : SettingValue();
  };
  add_frame_rate_setting(settings, "fps", job.frame_rate, "Views per second of a video");

  settings.begin_group("View synthesis");
  add_holes_setting(settings, job.synthesis.holes);
  add_soft_edges_setting(settings, job.synthesis.soft_edges);
  add_surface_settings(settings, job.synthesis);
}

std::vector<ScenePosition> positions_of(const SceneViewJob& job) {
  if (job.sweep.has_value() == !job.at.empty()) {
    throw UsageError(job.sweep ? "--at and --sweep are both given, expected one of them"
                               : "no view is given, expected --at X,Y or --sweep A:B:N");
  }
  if (!job.sweep) {
    return job.at;
  }
  std::vector<ScenePosition> positions;
  for (int i = 0; i < job.sweep->views; ++i) {
    const double t = static_cast<double>(i) / (job.sweep->views - 1);
    const auto between = [&](double first, double last) { return (1 - t) * first + t * last; };
    positions.push_back({between(job.sweep->first.x, job.sweep->last.x),
                         between(job.sweep->first.y, job.sweep->last.y)});
  }
  return positions;
}

SettingValue describe(ScenePosition position, const ScenePlace& place,
                      const SynthesizedView& view) {
  SettingValue sources = SettingValue::array();
  for (int k = 0; k < place.count; ++k) {
    const auto number = static_cast<std::size_t>(k);
    sources.push_back({{"image", place.vertices[number]}, {"weight", place.weights[number]}});
  }
  return {{"x", position.x},
          {"y", position.y},
          {"from", sources},
          {"is_outside", place.is_outside},
          {"hole_fraction", view.hole_fraction}};
}

}  // namespace

int command_scene_view(const Arguments& arguments) {
  SceneViewJob job;
  Settings settings("scene view", "Renders new views among the images of a scene.");
  add_settings(settings, job);
  add_common_settings(settings, job.common);
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  const std::vector<ScenePosition> positions = positions_of(job);
  const int views = static_cast<int>(positions.size());
  ViewOutput output(job.output, views);
  std::optional<ViewOutput> hole_mask;
  if (!job.hole_mask.empty()) {
    hole_mask.emplace(job.hole_mask, views);
  }
  job.synthesis.validate();
  job.common.execution.validate();
  const StoredScene scene = read_scene(job.scene);
  FileChecks files;
  files.add_input((std::filesystem::path(job.scene) / "scene.json").string());
  for (const StoredImage& image : scene.images) {
    files.add_input((std::filesystem::path(job.scene) / image.file).string());
  }
  output.check(files, "--output");
  if (hole_mask) {
    hole_mask->check(files, "--hole-mask");
  }
  files.add_output(job.common.report, "--report", OutputKind::kText);
  const SceneLayout layout(scene.positions(), scene.names());
  require_complete(scene, layout, job.scene);

  RunReport report(settings.command(), settings.values());
  force_instruction_set(job.common.isa);
  Execution execution(job.common.execution);
  report.set_execution(execution);
  double reading_seconds = 0;  // of the view under way
  const auto load = [&](int vertex) {
    const auto start = Clock::now();
    SceneVertex loaded = load_vertex(job.scene, scene, vertex);
    reading_seconds += seconds_since(start);
    return loaded;
  };
  SceneViewer viewer(layout, load, job.synthesis, execution);

  const std::atomic<bool>& interrupted = interrupt_flag();
  SettingValue results = SettingValue::array();
  SynthesizedView view;
  int outside = 0;
  {
    Progress progress("scene view", "views",
                      job.common.quiet || views == 1 ? ProgressStyle::kNone : ProgressStyle::kAuto);
    for (int index = 0; index < views && !interrupted.load(); ++index) {
      const ScenePosition position = positions[static_cast<std::size_t>(index)];
      const auto start = Clock::now();
      reading_seconds = 0;
      const ScenePlace place = viewer.synthesize(position, view);
      const double seconds = seconds_since(start) - reading_seconds;
      report.add_stage("read", reading_seconds);
      report.add_stage("views", seconds);
      report.add_compute_seconds(seconds);
      outside += place.is_outside ? 1 : 0;
      report.timed_file_access("write", [&] {
        output.write(index, view.image, job.frame_rate);
        if (hole_mask) {
          hole_mask->write(index, {view.holes.copy()}, job.frame_rate);
        }
      });
      results.push_back(describe(position, place, view));
      progress.update(index + 1, views, 0);
    }
  }
  if (interrupted.load()) {
    if (!job.common.quiet) {
      fmt::print(stderr, "scene view: interrupted after {} of {} views\n", results.size(), views);
    }
    return kExitInterrupted;
  }
  report.timed_file_access("write", [&] {
    output.finish();
    if (hole_mask) {
      hole_mask->finish();
    }
  });
  report.set_results({{"views", results}, {"views_outside", outside}});
  report.write(job.common.report);
  if (!job.common.quiet) {
    if (outside > 0) {
      fmt::print(stderr,
                 "scene view: {} of {} view{} outside of what the images enclose, made from the "
                 "nearest edge\n",
                 outside, views, views == 1 ? " is" : "s are");
    }
    fmt::print(stderr, "scene view: {}x{} pixels, {} view{} -> {}\n", view.image.width(),
               view.image.height(), views, views == 1 ? "" : "s", job.output);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
