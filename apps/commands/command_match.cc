#include "apps/commands/commands.h"
#include "apps/match/match_run.h"
#include "apps/settings/command_line.h"
#include "engine/options/settings.h"

namespace vantage::apps {

int command_match(const Arguments& arguments) {
  MatchJob job;
  Settings settings("match",
                    "Computes the disparity map of a rectified stereo pair, or of several images "
                    "taken on one line.");
  add_match_job_settings(settings, job);
  return read_command_line(settings, arguments) ? run_match(job, settings) : kExitDone;
}

}  // namespace vantage::apps
