#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/match/asp_job.h"
#include "apps/settings/command_line.h"
#include "engine/matching/options/method_names.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

void add_asp_settings(Settings& settings, AspJob& job) {
  settings.start_group("Files");
  settings.positional("left", job.left, "Left image, float TIFF, NaN: no data").required = true;
  settings.positional("right", job.right, "Right image of the same size").required = true;
  Setting& output = settings.positional("disparity", job.output,
                                        "Path to the disparity map: float TIFF, NaN: no data");
  output.required = true;
  output.path = PathRole::kOther;
  settings.start_group("Matching");
  settings.choice("preset", job.preset, names_of(MatchPreset{}),
                  "Parameters, as for 'vantage match'");
  settings.integer("disp-min", job.min_px, "PX",
                   "Minimum disparity, in the sign of --sign; auto: found in the images");
  settings.integer("disp-max", job.max_px, "PX", "Maximum disparity; auto: found in the images");
  settings.choice<DisparitySign>("sign", job.sign,
                                 {{"right-minus-left", DisparitySign::kRightMinusLeft},
                                  {"left-minus-right", DisparitySign::kLeftMinusRight}},
                                 "Disparities are x_right - x_left, as Ames Stereo Pipeline has "
                                 "them, or x_left - x_right, as the other commands have them");
  add_common_settings(settings, job.common);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "disparity", "preset", "disp-min", "disp-max", "sign", "threads", "quiet"},
      {"vantage asp left.tif right.tif disparity.tif",
       "parallel_stereo --stereo-algorithm \"vantage-asp --preset quality\" ..."});
}

}  // namespace

int command_asp(const Arguments& arguments) {
  AspJob job;
  Settings settings(
      "asp",
      "Matches a tile for Ames Stereo Pipeline: a disparity map with gaps where there is no data.");
  add_asp_settings(settings, job);
  return read_command_line(settings, arguments) ? run_asp(job, settings) : kExitDone;
}

}  // namespace vantage::apps
