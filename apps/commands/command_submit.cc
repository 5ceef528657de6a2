#include "apps/commands/commands.h"
#include "apps/settings/command_line.h"
#include "apps/submit/submit_job.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

void add_submit_settings(Settings& settings, SubmitJob& job) {
  settings.take_job_file();
  add_run_settings(settings, job.run);
  add_slurm_settings(settings, job.slurm);
  settings.choice("engine", job.engine, {{"slurm", BatchEngine::kSlurm}}, "Batch system");
  settings.flag("no-submit", job.no_submit, "Write the job scripts, but do not submit them");
  settings.set_short_help(
      {"left", "right", "stereo", "packing", "output", "save", "disparities", "preset", "shards",
       "partition", "time", "cpus", "slurm-memory", "no-submit"},
      {"vantage submit --shards 40 --left left/ --right right/ -o results",
       "vantage submit --shards 40 --time 4:00:00 --cpus 16 --left left/ --right right/ -o results",
       "vantage submit --shards 4 --no-submit --pairs pairs.csv -o results"});
}

}  // namespace

int command_submit(const Arguments& arguments) {
  SubmitJob job;
  Settings settings("submit", "Runs a sequence on a cluster: one task per shard, then the merge.");
  add_submit_settings(settings, job);
  return read_command_line(settings, arguments) ? run_submit(job, settings) : kExitDone;
}

}  // namespace vantage::apps
