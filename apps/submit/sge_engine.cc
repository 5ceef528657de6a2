#include <fmt/format.h>

#include "apps/submit/engine_table.h"
#include "apps/submit/task_script.h"

namespace vantage::apps {
namespace {

// Exit code 99 puts a task back into the queue. With -notify, USR2 tells all processes of a task
// that it will be killed. The script opens its log itself: `-o` would replace parts of some paths.
constexpr std::string_view kSgeIdentity = R"BASH(
task=$SGE_TASK_ID
job=${JOB_ID}_$task
node=$(hostname)
put_back() { exit 99; }
exec >>"$folder/task-$task.log" 2>&1
)BASH";

// The script announces the time limit to itself: SGE's soft limit (s_rt) comes as a kill to a task
// that has been put back.
constexpr std::string_view kTimer = R"BASH(
(
  trap 'kill "$sleeper"' TERM
  sleep "$seconds_to_end" &
  sleeper=$!
  wait "$sleeper" && kill -USR1 $$
) &
trap "kill $! 2>/dev/null" EXIT
)BASH";

}  // namespace

Submission sge_submission(const ArrayJob& job, const SubmitOptions& options) {
  const std::size_t cores = static_cast<std::size_t>(*job.cores);
  std::string identity(kSgeIdentity);
  std::string directives = fmt::format(
      "#$ -S /bin/bash\n#$ -N {}\n#$ -t 1-{}\n#$ -r y\n#$ -notify\n#$ -j y\n#$ -o /dev/null\n",
      job.name, job.tasks);
  if (job.concurrent) {
    directives += fmt::format("#$ -tc {}\n", *job.concurrent);
  }
  if (cores > 1) {
    directives += fmt::format("#$ -pe {} {}\n", options.parallel_environment, cores);
  }
  directives += fmt::format("#$ -l {}={}M\n", options.memory_resource,  // of a slot
                            mebibytes((*job.memory_bytes + cores - 1) / cores));
  if (job.time_limit_s) {
    directives += fmt::format("#$ -l h_rt={}\n", *job.time_limit_s);
    identity += fmt::format("seconds_to_end={}{}", *job.time_limit_s - job.drain_s, kTimer);
  }
  if (!options.queue.empty()) {
    directives += fmt::format("#$ -q {}\n", options.queue);
  }
  for (const std::string& option : options.qsub_options) {
    directives += fmt::format("#$ {}\n", option);
  }
  const ScriptDialect dialect = {.name = "SGE", .identity = identity, .stop_signal = "USR2"};
  return {.files = {{"array.sh", task_script(job, dialect, manifest_work(job), directives)}},
          .commands = {{"qsub", (job.folder / "array.sh").string()}}};
}

}  // namespace vantage::apps
