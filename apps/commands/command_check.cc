#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/match/check_job.h"
#include "apps/settings/command_line.h"
#include "engine/image/stereo_packing.h"
#include "engine/options/calibration_settings.h"
#include "engine/options/match_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/scene_mask_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

void add_check_settings(Settings& settings, CheckJob& job) {
  settings.start_group("Input");
  settings
      .positional("left", job.left,
                  "Left photograph, or a sequence: a folder, a pattern (left/%06d.png), a glob or "
                  "a video; alone: pictures that hold both images")
      .required = true;
  settings.positional("right", job.right, "Right photograph or sequence");
  settings.choice<StereoPacking>("packing", job.input.packing, stereo_packing_names(),
                                 "Stereo layout of pictures that hold both images, as of 'run'",
                                 "none");
  settings.input_path("calibration", job.calibration, "FILE",
                      "Cameras, to rectify the pair first: OpenCV, Middlebury or KITTI file");
  add_kitti_cameras_setting(settings, job.kitti_cameras);
  add_scene_mask_settings(settings, job.input.masks, true);
  add_white_level_setting(settings, job.input.white_level);
  add_match_settings(settings, job.sequence.match);
  add_common_settings(settings, job.common);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "packing", "calibration", "report", "threads", "quiet"},
      {"vantage check left.png right.png", "vantage check left/ right/ --report check.json",
       "vantage check film.mp4 --packing sbsl"});
}

}  // namespace

int command_check(const Arguments& arguments) {
  CheckJob job;
  Settings settings("check",
                    "Says what a pair or a sequence is like, what a match of it would cost, and "
                    "which command to type. Exit code 1 where a match makes no sense.");
  add_check_settings(settings, job);
  return read_command_line(settings, arguments) ? run_check(job, settings) : kExitDone;
}

}  // namespace vantage::apps
