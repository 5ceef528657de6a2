#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/inputs/rectification_check.h"
#include "apps/scene/scene_build_job.h"
#include "apps/settings/command_line.h"
#include "engine/options/match_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

void add_file_settings(Settings& settings, SceneBuildJob& job) {
  settings.start_group("Files");
  add_scene_images_settings(settings, job.images);
  settings.integer(
      "neighbours", job.neighbours, "N",
      "Neighbours that each image of --poses is matched with, the nearest in different "
      "directions");
  add_white_level_setting(settings, job.white_level);
  add_reading_settings(settings, job.reading);
  Setting& output = settings.path("output", job.output, "SCENE",
                                  "Folder of the scene; existing results are kept");
  output.short_name = 'o';
  output.required = true;
  add_overwrite_setting(settings, job.overwrite);
  Setting& copy =
      settings.add("copy-images", "", "Copy the images into the folder, so that it can be moved");
  copy.kind = ValueKind::kTruth;
  copy.set = [&job](const SettingValue& value) { job.copy_images = to_truth(value); };
  copy.get = [&job] { return job.copy_images; };
}

void add_scene_build_settings(Settings& settings, SceneBuildJob& job) {
  add_file_settings(settings, job);
  add_match_settings(settings, job.match);
  settings.start_group("Check");
  add_rows_setting(settings, job.rows).help =
      "Rows that do not correspond, of cameras in a row or grid. auto: images that differ from "
      "their neighbours in a row by a smooth offset of up to a few pixels are resampled";
  add_rectification_check_setting(
      settings, job.check_rectification,
      "Accept neighbours as they are: correct no rows, and do not check that they correspond and "
      "that enough pixels match");
  add_common_settings(settings, job.common);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"images", "grid", "spacing", "positions", "poses", "output", "disparities", "preset",
       "threads", "quiet"},
      {"vantage scene build --images photographs/ --spacing 0.2,1 -o scene",
       "vantage scene build --images photographs/ --grid 5x3 --spacing 10,12.5 -o scene",
       "vantage scene build --positions positions.csv --preset quality -o scene",
       "vantage scene build --poses sparse/ --images photographs/ -o scene"});
}

}  // namespace

int command_scene_build(const Arguments& arguments) {
  SceneBuildJob job;
  Settings settings(
      "scene build",
      "Matches neighbouring images of a row or grid of cameras, or of hand-held cameras with poses "
      "('vantage scene poses'). --disparities is for the nearest neighbours; with --poses for "
      "those at the median distance.");
  add_scene_build_settings(settings, job);
  return read_command_line(settings, arguments) ? run_scene_build(job, settings) : kExitDone;
}

}  // namespace vantage::apps
