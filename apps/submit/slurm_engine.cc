#include "apps/submit/slurm_engine.h"

#include <fmt/format.h>

#include <cctype>
#include <string_view>
#include <utility>

#include "apps/submit/engine_table.h"
#include "engine/error.h"

namespace vantage::apps {
namespace {

// USR1 comes from Slurm ahead of the time limit, to the script alone. TERM comes to all processes
// of a task that is cancelled or has to make room: that one must not go back into the queue by
// itself. SLURM_JOB_ID would not do as the task's name: for one of the tasks it is the whole array.
constexpr ScriptDialect kSlurmDialect = {.name = "Slurm",
                                         .identity = R"BASH(
task=$SLURM_ARRAY_TASK_ID
job=${SLURM_ARRAY_JOB_ID}_$task
node=${SLURMD_NODENAME:-$(hostname)}
put_back() {
  if scontrol requeue "$job"; then exit 0; fi
  say "cannot be put back into the queue"
  exit 1
}
)BASH",
                                         .stop_signal = "TERM"};

/// `path` in a directive for a log, where sbatch replaces '%' patterns.
std::string log_path(const std::filesystem::path& path) {
  std::string text;
  for (const char letter : path.string()) {
    text += letter == '%' ? std::string("%%") : std::string(1, letter);
  }
  return text;
}

/// The directives of all scripts, those of the user last: sbatch uses the last of two.
std::string common_directives(const ArrayJob& job, const SubmitOptions& options) {
  std::string text = "#SBATCH --open-mode=append\n#SBATCH --requeue\n#SBATCH --ntasks=1\n";
  for (const auto& [name, value] :
       {std::pair("partition", options.partition), std::pair("account", options.account),
        std::pair("time", job.time_limit_s ? duration_text(*job.time_limit_s) : ""),
        std::pair("mem",
                  job.memory_bytes ? fmt::format("{}M", mebibytes(*job.memory_bytes)) : "")}) {
    if (!value.empty()) {
      text += fmt::format("#SBATCH --{}={}\n", name, value);
    }
  }
  for (const std::string& option : options.sbatch_options) {
    text += fmt::format("#SBATCH {}\n", option);
  }
  return text;
}

}  // namespace

void require_folder_for_slurm(const std::filesystem::path& folder) {
  for (const unsigned char letter : folder.string()) {
    if (std::iscntrl(letter) != 0 || letter == '"' || letter == '\\') {
      throw UsageError(fmt::format(
          "--output is '{}', expected a folder without line breaks, \" and \\ for Slurm",
          folder.string()));
    }
  }
}

std::string slurm_array_script(const ArrayJob& job, const SubmitOptions& options,
                               const TaskWork& work) {
  std::string directives = fmt::format("#SBATCH --job-name={}\n", job.name);
  directives += fmt::format("#SBATCH --array=1-{}{}\n", job.tasks,
                            job.concurrent ? fmt::format("%{}", *job.concurrent) : "");
  directives += fmt::format("#SBATCH --output=\"{}/task-%a.log\"\n", log_path(job.folder));
  directives += fmt::format("#SBATCH --signal=B:USR1@{}\n", job.drain_s);
  if (job.cores) {
    directives += fmt::format("#SBATCH --cpus-per-task={}\n", *job.cores);
  }
  return task_script(job, kSlurmDialect, work, directives + common_directives(job, options));
}

std::string slurm_job_script(const ArrayJob& job, const SubmitOptions& options,
                             const std::string& name, const std::string& command) {
  return fmt::format(
      "#!/bin/bash\n# Written by 'vantage submit'.\n#SBATCH --job-name={}-{}\n"
      "#SBATCH --output=\"{}/{}.log\"\n{}\n{}\n",
      job.name, name, log_path(job.folder), name, common_directives(job, options), command);
}

Submission slurm_submission(const ArrayJob& job, const SubmitOptions& options) {
  require_folder_for_slurm(job.folder);
  return {.files = {{"array.sh", slurm_array_script(job, options, manifest_work(job))}},
          .commands = {{"sbatch", (job.folder / "array.sh").string()}}};
}

}  // namespace vantage::apps
