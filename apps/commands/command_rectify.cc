#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/match/rectify_job.h"
#include "apps/settings/command_line.h"
#include "engine/options/calibration_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

void add_rectify_settings(Settings& settings, RectifyJob& job) {
  settings.start_group("Input");
  settings
      .positional("left", job.input.left,
                  "Left photograph, or several from a fixed rig: a folder, a pattern "
                  "(left/%06d.png), a glob or a video")
      .required = true;
  settings.positional("right", job.input.right, "Right photograph or photographs of the same size")
      .required = true;
  add_pair_by_setting(settings, job.input.pair_by);
  settings.input_path(
      "calibration", job.calibration, "FILE",
      "Cameras: file of any tool, or two (A,B); default: estimated from the images");
  add_calibration_choice_settings(settings, job.calibration_choice);
  Setting& board = settings.add(
      "board", "BOARD",
      std::string("Cameras from pairs that show a flat board, in different places, tilted. ") +
          kBoardHelp);
  board.set = [&job](const SettingValue& value) {
    const std::string text = to_text(value);
    job.board = text == "none" ? std::nullopt : std::optional(parse_board(text));
  };
  board.get = [&job]() -> SettingValue { return job.board ? job.board->text : "none"; };
  settings.number("baseline", job.baseline_m, "METRES",
                  "Distance of the cameras: gives estimated cameras their scale; auto: that of "
                  "--calibration");
  settings.integer(
      "sample-pairs", job.sample_pairs, "N",
      "Maximum number of pairs to estimate the cameras from and to measure row errors in; auto: "
      "10, or 50 of a board");
  add_white_level_setting(settings, job.input.white_level);
  add_reading_settings(settings, job.input.reading);
  settings.start_group("Output: at least one of these");
  settings
      .path(
          "output", job.output, "DIR",
          "Folder for the rectified images, which keep the names of the photographs: DIR/NAME.png; "
          "for several pairs, or equal names, DIR/left/NAME.png and DIR/right/NAME.png")
      .short_name = 'o';
  add_overwrite_setting(settings, job.overwrite);
  settings.path(
      "matrices", job.matrices, "FILE",
      "Write cameras, rectifying rotations, homographies and the valid region in OpenCV's format: "
      ".yml .yaml .xml .json; YAML and XML can be used as --calibration");
  settings.path("valid-mask", job.valid_mask, "MASK.png",
                "Write a mask of the pixels that both rectified images cover");
  add_kept_outline_setting(settings, job.rectification);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "calibration", "board", "output", "matrices", "valid-mask", "kept-outline",
       "threads", "quiet"},
      {"vantage rectify left.jpg right.jpg -o rectified",
       "vantage rectify left/ right/ -o rectified --matrices rig.yml",
       "vantage rectify board/left/ board/right/ --board 9x6:25mm --matrices rig.yml",
       "vantage rectify left.jpg right.jpg --calibration rig.yml -o rectified"});
}

}  // namespace

int command_rectify(const Arguments& arguments) {
  RectifyJob job;
  Settings settings("rectify",
                    "Rectifies photographs of two cameras so that their rows correspond, and "
                    "reports the remaining error.");
  add_rectify_settings(settings, job);
  return read_command_line(settings, arguments) ? run_rectify(job, settings) : kExitDone;
}

}  // namespace vantage::apps
