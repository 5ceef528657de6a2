#include "apps/pair_source_settings.h"

#include <string>
#include <utility>

#include "apps/frame_step_setting.h"
#include "apps/stream_run.h"

namespace vantage::apps {

void add_pair_source_settings(Settings& settings, PairSourceOptions& input) {
  const auto path = [&](std::string name, std::string& field, std::string value_name,
                        std::string help) {
    // The journal identifies inputs by their content.
    settings.input_path(std::move(name), field, std::move(value_name), std::move(help))
        .changes_results = false;
  };
  path("left", input.left, "SOURCE",
       "Left frames: a folder, pattern (left/%06d.png), glob or video");
  path("right", input.right, "SOURCE", "Right frames");
  settings.integer("offset", input.offset_frames, "N", "Pair left frame i with right frame i + N");
  path("stereo", input.stereo, "SOURCE",
       "Frames with both images, see --packing; -: y4m on standard input");
  settings.choice<StereoPacking>(
      "packing", input.packing, stereo_packing_names(),
      "Stereo layout (ffmpeg's stereo3d names): sbsl side by side, left first; abl "
      "above/below, left on top; sbs2l, ab2l half size",
      "none");
  add_raw_video_setting(settings, input.raw_video);
  path("pairs", input.pairs, "FILE.csv", "List of image files, one line left,right per pair");
  path("sequence", input.sequence, "SOURCE", "Frames of one moving camera; see --step");
  settings.integer("step", input.step, "K",
                   "Frame t is the left image, frame t + K the right image");
  add_frame_step_setting(settings, input.every);
}

}  // namespace vantage::apps
