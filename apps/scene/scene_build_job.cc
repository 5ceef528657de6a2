#include "apps/scene/scene_build_job.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "apps/commands/commands.h"
#include "apps/inputs/rectification_check.h"
#include "apps/process/command_work.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/run_report.h"
#include "apps/scene/scene_rectification.h"
#include "engine/error.h"
#include "engine/io/files/existing_files.h"
#include "engine/options/match_settings.h"
#include "engine/scene_graph/scene_builder.h"

namespace vantage::apps {
namespace {

/// The settings that an edge's maps depend on, as JSON.
std::string match_settings_of(MatchOptions match) {
  Settings settings("match", "");
  add_match_settings(settings, match);
  return settings.result_values().dump();
}

void check(const SceneBuildJob& job) {
  job.common.execution.validate();
  const std::filesystem::path folder = job.output;
  if (std::filesystem::exists(folder) && !std::filesystem::is_directory(folder)) {
    throw UsageError(fmt::format("--output is '{}', a file; expected a folder", job.output));
  }
}

void check_files(const SceneBuildJob& job, const Settings& settings,
                 const std::vector<SceneImage>& images) {
  FileChecks files(settings);
  for (const SceneImage& image : images) {
    files.add_input(image.file);
  }
  const std::filesystem::path folder = job.output;
  if (!job.overwrite && !std::filesystem::exists(folder / "scene.json")) {
    require_no_existing_file(folder / "maps", [](const std::string&) { return true; });
  }
  files.add_made_file(folder / "scene.json", "--output");
  files.add_made_folder(folder / "maps", "--output");
  check_common_files(job.common, files);
}

SettingValue describe_edge(const BuiltEdge& built, SettingValue rectification) {
  const StoredEdge& edge = built.stored;
  if (!built.refusal.empty()) {
    return {{"first", edge.edge.first},
            {"second", edge.edge.second},
            {"length", edge.edge.length},
            {"refused", built.refusal}};
  }
  SettingValue values = {
      {"first", edge.edge.first},
      {"second", edge.edge.second},
      {"length", edge.edge.length},
      {"disparities", fmt::format("{}:{}", edge.disparities.min, edge.disparities.max)},
      {"matched_share", edge.matched_share},
      {"rectification", std::move(rectification)}};
  if (edge.corrected_degrees) {
    values["pose_corrected_degrees"] = *edge.corrected_degrees;
  }
  return values;
}

/// For the report: each corrected image, with its rows relative to its left neighbour.
SettingValue describe_rows(const std::vector<CorrectedImage>& images) {
  SettingValue described = SettingValue::array();
  for (const CorrectedImage& image : images) {
    described.push_back(row_values(image.rows, true));
    described.back()["image"] = image.vertex;
  }
  return described;
}

}  // namespace

int run_scene_build(const SceneBuildJob& job, const Settings& settings) {
  check(job);
  const SceneBuildOptions options{.match = job.match,
                                  .settings = match_settings_of(job.match),
                                  .copy_images = job.copy_images,
                                  .check_rectification = job.check_rectification,
                                  .rows = job.rows,
                                  .neighbours = job.neighbours,
                                  .white_level = job.white_level,
                                  .reading = job.reading};
  options.validate();
  CommandWork work(settings, job.common, reported_settings(settings, job.match));
  RunReport& report = work.report;
  Execution& execution = work.execution;

  std::vector<std::string> remarks;
  SceneBuilder builder = report.timed_file_access("read", [&] {
    std::vector<SceneImage> images = scene_images(job.images, settings, remarks);
    check_files(job, settings, images);
    return SceneBuilder(job.output, std::move(images), options, execution);
  });
  tell_remarks(builder.remarks(), job.common, report);
  if (!job.common.quiet) {
    for (const std::string& remark : remarks) {
      tell("scene build: note: {}\n", remark);
    }
  }
  const std::atomic<bool>& interrupted = interrupt_flag();
  const int edges = static_cast<int>(builder.edges().size());
  const int to_match = static_cast<int>(builder.edges_to_match().size());
  SettingValue matched = SettingValue::array();
  int refused = 0;
  int corrected = 0;
  SceneRectification rectification(builder, job.match);
  {
    Progress progress("scene build", "edges",
                      job.common.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
    double cells = 0;
    for (const int edge : builder.edges_to_match()) {
      if (interrupted.load()) {
        break;
      }
      MatchReport match;
      const auto built = report.timed_compute([&] { return builder.build(edge, &match); });
      if (built.refusal.empty()) {
        report.add_match(match);
      }
      if (job.check_rectification) {
        report.add_stage("check", built.check_seconds);
        report.add_compute_seconds(-built.check_seconds);
      }
      cells += match.cells;
      refused += built.refusal.empty() ? 0 : 1;
      corrected += built.stored.corrected_degrees && built.refusal.empty() ? 1 : 0;
      matched.push_back(describe_edge(built, rectification.add(built)));
      progress.update(static_cast<int>(matched.size()), to_match, cells);
    }
  }
  if (!job.common.quiet) {
    rectification.print_warnings();
  }
  const int done = static_cast<int>(matched.size());
  if (done < to_match) {
    if (!job.common.quiet) {
      tell("scene build: interrupted after {} of {} edges; run the same command to continue\n",
           edges - to_match + done, edges);
    }
    return kExitInterrupted;
  }
  builder.require_all_joined();
  report.set_results({{"images", builder.images()},
                      {"remarks", remarks},
                      {"triangles", builder.triangles()},
                      {"rows", describe_rows(builder.corrected_images())},
                      {"edges", edges},
                      {"edges_refused", refused},
                      {"poses_corrected", corrected},
                      {"edges_kept", edges - to_match},
                      {"edges_matched", matched}});
  report.write(job.common.report);
  if (!job.common.quiet) {
    tell("scene build: {} images, {} edges, {} of them matched now -> {}\n", builder.images(),
         edges, done - refused, job.output);
    if (refused + corrected > 0) {
      tell(
          "scene build: {} edges were refused and left out, of {} the pose was corrected; "
          "'vantage scene info' lists them\n",
          refused, corrected);
    }
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
