#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/scene/scene_view_job.h"
#include "apps/settings/command_line.h"
#include "engine/options/settings.h"
#include "engine/options/synthesis_settings.h"

namespace vantage::apps {
namespace {

void add_settings(Settings& settings, SceneViewJob& job) {
  settings.start_group("Files");
  settings.positional("scene", job.scene, "Folder made by 'vantage scene build'").required = true;
  add_view_file_settings(settings, job.output);

  settings.start_group("Views");
  add_wanted_scene_views(settings, job.views);
  add_view_display_settings(settings, job.output,
                            "lengths of the scene's shortest edge; with poses, of its median edge");

  settings.start_group("View synthesis");
  settings.integer("sources", job.sources, "N",
                   "Photographs that a view of a scene with poses is blended from");
  add_holes_setting(settings, job.synthesis.holes);
  add_soft_edges_setting(settings, job.synthesis.soft_edges);
  add_surface_settings(settings, job.synthesis);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"scene", "output", "at", "sweep", "path", "between", "pose", "stereo-packing", "fps",
       "holes", "threads", "quiet"},
      {"vantage scene view scene --at 0.25,0 -o between.png",
       "vantage scene view scene --sweep 0,0:0.6,0:60 -o along.mp4",
       "vantage scene view posed --between 3:7:0.5 -o between.png",
       "vantage scene view scene --at 0.25,0 --stereo-packing arcd -o anaglyph.png"});
}

}  // namespace

int command_scene_view(const Arguments& arguments) {
  SceneViewJob job;
  Settings settings("scene view", "Renders new views between the images of a scene.");
  add_settings(settings, job);
  return read_command_line(settings, arguments) ? run_scene_view(job, settings) : kExitDone;
}

}  // namespace vantage::apps
