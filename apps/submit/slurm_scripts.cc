#include "apps/submit/slurm_scripts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "apps/process/child_process.h"
#include "engine/error.h"

namespace vantage::apps {
namespace {

/// `path` in a directive for a log, where sbatch replaces '%' patterns.
std::string log_path(const std::filesystem::path& path) {
  std::string text;
  for (const char letter : path.string()) {
    text += letter == '%' ? std::string("%%") : std::string(1, letter);
  }
  return text;
}

std::string job_name(const std::filesystem::path& run_folder) {
  std::string name = run_folder.filename().string();
  std::ranges::replace_if(
      name, [](unsigned char letter) { return std::isalnum(letter) == 0 && letter != '-'; }, '_');
  return name;
}

/// The directives of both scripts, after those of the user: sbatch uses the last of two.
std::string common_directives(const SlurmOptions& options) {
  std::string text = "#SBATCH --open-mode=append\n#SBATCH --requeue\n#SBATCH --ntasks=1\n";
  for (const auto& [name, value] :
       {std::pair("partition", options.partition), std::pair("account", options.account),
        std::pair("time", options.time_limit), std::pair("mem", options.memory)}) {
    if (!value.empty()) {
      text += fmt::format("#SBATCH --{}={}\n", name, value);
    }
  }
  for (const std::string& option : options.sbatch_options) {
    text += fmt::format("#SBATCH {}\n", option);
  }
  return text;
}

/// Frames that take longer are given up while there is time left to be queued again.
int seconds_to_drain(const SlurmOptions& options) {
  return std::max(1, options.drain_seconds_or_default() * 3 / 4);
}

// USR1 comes from Slurm ahead of the time limit, to this script alone. TERM comes to all processes
// of a task that is cancelled or has to make room: that one must not go back into the queue by
// itself. SLURM_JOB_ID would not do as the task's name: for one of the tasks it is the whole array.
constexpr std::string_view kArrayBody = R"BASH(
set -u
shard=$SLURM_ARRAY_TASK_ID
task=${SLURM_ARRAY_JOB_ID}_$shard
failures=$folder/failures-$task
finished_frames=$folder/../frames-$part_prefix$shard-of-$shards.jsonl

say() { echo "== $(date '+%F %T') shard $shard/$shards: $*"; }

count_lines() {
  if [[ -r $1 ]]; then wc -l <"$1"; else echo 0; fi
}

back_into_queue() {
  if scontrol requeue "$task"; then
    exit 0
  fi
  say "cannot be put back into the queue"
  exit 1
}

run='' stopped_by='' trapped=false
stop_before_time_limit() {
  trapped=true stopped_by=time-limit
  say "the time limit is near, finishing the frames under way"
  if [[ -n $run ]]; then
    kill -TERM "$run"
    (sleep "$drain_seconds" && kill -KILL "$run") &
  fi
}
stop_for_slurm() {
  trapped=true stopped_by=${stopped_by:-slurm}
  if [[ -n $run ]]; then kill -INT "$run"; fi
}
trap stop_before_time_limit USR1
trap stop_for_slurm TERM

node=${SLURMD_NODENAME:-$(hostname)}
say "started on $node as job $task (earlier starts: ${SLURM_RESTART_COUNT:-0}, of them failed:" \
  "$(count_lines "$failures"))"
frames_before=$(count_lines "$finished_frames")
"$program" run "$folder/job.toml" --shard "$shard/$shards" --resume --progress plain \
  --report "$folder/report-$shard.json" "${threads[@]}" &
run=$!
if [[ -n $stopped_by ]]; then kill -TERM "$run"; fi
while
  trapped=false
  wait "$run"
  code=$?
  $trapped # then it was a signal that ended the waiting
do :; done

case $code in
  0)
    say "done"
    exit 0
    ;;
  3)
    say "done, but frames were skipped, see above"
    exit 0
    ;;
  2)
    say "refused, see above"
    exit 2
    ;;
esac
if [[ $stopped_by == slurm ]]; then
  say "stopped by Slurm (exit code $code)"
  exit "$code"
fi
if [[ $stopped_by == time-limit ]]; then
  if [[ $(count_lines "$finished_frames") -gt $frames_before ]]; then
    say "goes on in a new job"
    back_into_queue
  fi
  say "no frame was finished within the time limit"
fi
echo "$(date '+%F %T') exit code $code on $node" >>"$failures"
if [[ $(count_lines "$failures") -le $retries ]]; then
  say "failed with exit code $code, is tried again"
  back_into_queue
fi
say "failed with exit code $code, given up after $(count_lines "$failures") attempts"
exit "$code"
)BASH";

}  // namespace

void require_folder_for_scripts(const std::filesystem::path& run_folder) {
  for (const unsigned char letter : run_folder.string()) {
    if (std::iscntrl(letter) != 0 || letter == '"' || letter == '\\') {
      throw UsageError(fmt::format(
          "--output is '{}', expected a folder without line breaks, \" and \\ for Slurm",
          run_folder.string()));
    }
  }
}

std::string array_script(const SlurmOptions& options, const SlurmRun& run) {
  const std::filesystem::path folder = slurm_folder(run.folder);
  std::string text =
      fmt::format("#!/bin/bash\n# Task i makes shard i/{} of a run. Written by 'vantage submit'.\n",
                  options.shards);
  text += fmt::format("#SBATCH --job-name=vantage-{}\n", job_name(run.folder));
  text += fmt::format("#SBATCH --array=1-{}{}\n", options.shards,
                      options.concurrent ? fmt::format("%{}", *options.concurrent) : "");
  text += fmt::format("#SBATCH --output=\"{}/task-%a.log\"\n", log_path(folder));
  text += fmt::format("#SBATCH --signal=B:USR1@{}\n", options.drain_seconds_or_default());
  if (options.cpus) {
    text += fmt::format("#SBATCH --cpus-per-task={}\n", *options.cpus);
  }
  text += common_directives(options);
  text += fmt::format(
      "\nprogram={}\nfolder={}\nshards={}\npart_prefix={}\nretries={}\ndrain_seconds={}\n",
      shell_word(run.program), shell_word(folder.string()), options.shards,
      shell_word(run.part_prefix), options.retries, seconds_to_drain(options));
  text += run.threads_from_slurm
              ? "threads=(--threads \"${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-1}}\")\n"
              : "threads=()\n";
  return text + std::string(kArrayBody);
}

std::string merge_script(const SlurmOptions& options, const SlurmRun& run) {
  std::string text =
      "#!/bin/bash\n# Checks that a run is complete and joins its videos. Written by 'vantage "
      "submit'.\n";
  text += fmt::format("#SBATCH --job-name=vantage-merge-{}\n", job_name(run.folder));
  text += fmt::format("#SBATCH --output=\"{}/merge.log\"\n", log_path(slurm_folder(run.folder)));
  text += common_directives(options);
  // For a partial run, merge must ignore frames outside the selection.
  return text + fmt::format("\nexec {} merge{} {}\n", shell_word(run.program),
                            run.part_prefix.empty() ? "" : " --partial",
                            shell_word(run.folder.string()));
}

}  // namespace vantage::apps
