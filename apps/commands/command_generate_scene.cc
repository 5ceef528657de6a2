#include "apps/commands/commands.h"
#include "apps/match/scene_job.h"
#include "apps/settings/command_line.h"
#include "engine/options/settings.h"
#include "engine/options/wanted_views.h"

namespace vantage::apps {
namespace {

void add_scene_settings(Settings& settings, SceneJob& job) {
  settings.start_group("Files");
  Setting& output = settings.path("output", job.output, "DIR", "Output folder");
  output.short_name = 'o';
  output.required = true;
  add_overwrite_setting(settings, job.overwrite);
  settings.integer("frames", job.frames, "N",
                   "Number of frames of a sequence (DIR/left/000000.png ...); single: one pair "
                   "(DIR/left.png ...)",
                   "single");
  add_view_setting(settings, job.views);
  settings.input_path("pose", job.pose_file, "FILE",
                      "Also render the cameras of this file of poses as camera-0, camera-1, ...; "
                      "the file is as for 'vantage synth', with t in baselines");

  settings.start_group("Scene");
  LayeredSceneOptions& scene = job.scene;
  settings.integer("width", scene.width_px, "PX", "Width of the images");
  settings.integer("height", scene.height_px, "PX", "Height of the images");
  settings.number("far", scene.far_disparity_px, "PX",
                  "Minimum disparity of the scene; auto: width / 80");
  settings.number("near", scene.near_disparity_px, "PX",
                  "Maximum disparity of the scene; auto: width / 16");
  settings.integer("frames-per-cycle", scene.frames_per_cycle, "N",
                   "Number of frames after which all movements repeat");
  settings.number("camera-speed", job.camera_speed, "B",
                  "Movement of both cameras to the right per frame, in baselines");
  settings.flag("boards", scene.has_boards,
                "Boards without texture, facing the cameras and slanted, in place of the other "
                "objects; DIR/left-uniform.png and right-uniform.png are white there");
  settings.integer("samples", scene.samples_per_side, "N", "Average N x N samples per pixel");
  settings.number("right-gain", scene.right_gain, "G",
                  "Gain of the right camera, whose intensity is G * I + O");
  settings.number("right-offset", scene.right_offset, "O",
                  "Offset of the right camera in grey levels; see --right-gain");
  settings.number("noise", scene.noise_sigma, "SIGMA",
                  "Standard deviation of the noise in all images, in grey levels");
  add_seed_setting(settings, scene.seed);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  settings.set_short_help(
      {"output", "frames", "view", "pose", "width", "height", "far", "near", "frames-per-cycle",
       "noise", "seed"},
      {"vantage generate scene -o scene", "vantage generate scene --frames 100 -o sequence",
       "vantage generate scene --view 0.5 --width 1280 --height 720 -o scene"});
}

}  // namespace

int command_generate_scene(const Arguments& arguments) {
  SceneJob job;
  Settings settings(
      "generate scene",
      "Renders an artificial moving scene for both cameras, with its true disparities.");
  add_scene_settings(settings, job);
  return read_command_line(settings, arguments) ? generate_scene(job, settings) : kExitDone;
}

}  // namespace vantage::apps
