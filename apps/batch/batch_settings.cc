#include "apps/batch/batch_settings.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "apps/batch/array_variables.h"
#include "apps/inputs/input_limits.h"
#include "engine/error.h"
#include "engine/io/files/remote_files.h"

namespace vantage::apps {
namespace {

constexpr double kDay_s = 24 * 60 * 60;

/// "90s", "20min", "1.5h" or seconds.
double to_seconds(const SettingValue& value) {
  constexpr std::array<std::pair<std::string_view, double>, 5> kUnits = {
      {{"min", 60}, {"ms", 1e-3}, {"s", 1}, {"h", 60 * 60}, {"d", kDay_s}}};
  try {
    if (value.is_string()) {
      const std::string text = value.get<std::string>();
      for (const auto& [unit, seconds] : kUnits) {
        if (text.ends_with(unit)) {
          return seconds * to_number(text.substr(0, text.size() - unit.size()));
        }
      }
    }
    return to_number(value);
  } catch (const UsageError&) {
    reject_value(value, "a time such as 90s, 20min or 2h");
  }
}

void add_duration_setting(Settings& settings, std::string name, double& seconds, double min_s,
                          double max_s, std::string help) {
  Setting& setting = settings.add(std::move(name), "TIME", std::move(help));
  setting.set = [&seconds, min_s, max_s](const SettingValue& value) {
    seconds = to_seconds(value);
    if (!(seconds >= min_s && seconds <= max_s)) {
      reject_value(value, fmt::format("{} s to {} s", min_s, max_s));
    }
  };
  setting.get = [&seconds] { return fmt::format("{}s", seconds); };
}

void add_task_setting(Settings& settings, std::optional<ArrayTask>& task) {
  Setting& setting = settings.add(
      "index", "auto|K/N",
      "Do the jobs K, K + N, K + 2N … only, as task K of N of a job array; auto: as SLURM_, "
      "AWS_BATCH_, SGE_, PBS_ or JOB_COMPLETION_INDEX says, of VANTAGE_BATCH_TASKS tasks where the "
      "engine does not say how many");
  setting.words = {"auto", "none"};
  setting.set = [&task](const SettingValue& value) {
    if (is_word(value, "none")) {
      task.reset();
      return;
    }
    task = is_word(value, "auto") ? task_of_environment() : to_array_task(to_text(value));
    if (!task) {
      reject_value(value, "K/N with 1 <= K <= N such as 2/40, or auto in a task of a job array");
    }
  };
  setting.get = [&task]() -> SettingValue {
    return task ? fmt::format("{}/{}", task->index, task->count) : "none";
  };
}

}  // namespace

void add_job_settings(Settings& settings, BatchJob& job) {
  settings.start_group("Batch", false);
  add_duration_setting(settings, "job-time", job.job_seconds, 1, 7 * kDay_s,
                       "Time that a job should take: small items come together, large films are "
                       "divided");
  settings.integer("attempts", job.attempts, "N",
                   "How often an item is tried that fails, 1 to 100");
  add_duration_setting(settings, "lease", job.lease_seconds, 2, kDay_s,
                       "A worker that shows no sign of life for so long is taken for dead, and "
                       "others take its jobs");
  settings.path("scratch", job.scratch, "DIR",
                "With an output at s3://: folder of this machine in which runs work; default: that "
                "of temporary files");
  add_size_setting(settings, "scratch-limit", job.scratch_limit_bytes,
                   "What a run may take there, such as 20G: results are put into the store before "
                   "it is half full; auto: no limit");
  add_duration_setting(settings, "keep-every", job.keep_seconds, 1, kDay_s,
                       "With an output at s3://: time between two times that finished frames and "
                       "chunks are put there; what a worker that dies loses");
}

void add_batch_settings(Settings& settings, BatchJob& job) {
  settings
      .positional(
          "manifest", job.manifest,
          "CSV file with a heading, or JSON lines: an item each, with output, inputs such as "
          "left and right or stereo, and any option of run")
      .required = true;
  add_run_settings(settings, job.run);
  add_job_settings(settings, job);
  settings.flag("worker", job.worker,
                "Join the batch in the output folder, or start it: take jobs until none is left");
  add_task_setting(settings, job.task);
  settings.flag("retry-failed", job.retry_failed, "Try the items again that have failed");
  add_duration_setting(settings, "grace", job.grace_seconds, 1, kDay_s,
                       "After SIGTERM: time to finish frames and to hand back the rest");
  settings.path("metrics", job.metrics, "FILE",
                "Write counters for Prometheus's textfile collector, after each job");
  settings.set_short_help(
      {"manifest", "output", "save", "preset", "job-time", "worker", "index", "dry-run", "resume",
       "retry-failed", "metrics"},
      {"vantage batch films.csv -o results --dry-run",
       "vantage batch films.csv -o results --save depth-video --preset realtime",
       "vantage batch films.csv -o results --worker"});
}

void check_batch(const BatchJob& job, const Settings& settings) {
  constexpr const char* kOfItem = "is a column of the manifest, expected it there";
  constexpr const char* kOfBatch = "has no sense for a batch";
  for (const auto& [name, why] : {std::pair{"left", kOfItem},
                                  {"right", kOfItem},
                                  {"stereo", kOfItem},
                                  {"pairs", kOfItem},
                                  {"sequence", kOfItem},
                                  {"more", kOfItem},
                                  {"frames", kOfItem},
                                  {"shard", kOfBatch},
                                  {"overwrite", kOfBatch},
                                  {"force", kOfBatch},
                                  {"live", kOfBatch},
                                  {"show", kOfBatch},
                                  {"trace", kOfBatch},
                                  {"raw-video", kOfBatch}}) {
    if (settings.is_set(name)) {
      throw UsageError(fmt::format("--{} {}", name, why));
    }
  }
  if (job.run.output == "-") {
    throw UsageError("--output is -, expected a folder: items have folders of their own");
  }
  if (job.worker && job.task) {
    throw UsageError("--worker and --index are both given, expected one of them");
  }
  if (job.run.resume && (job.worker || job.task)) {
    throw UsageError(fmt::format("--resume has no effect with --{}, which joins what is there",
                                 job.worker ? "worker" : "index"));
  }
  if (!is_address(job.run.output)) {
    settings.refuse_idle({"scratch", "scratch-limit", "keep-every"},
                         "without an output at s3://, expected it with one only");
  }
  if (job.attempts < 1 || job.attempts > 100) {
    throw UsageError(
        fmt::format("--attempts is {}, expected a number from 1 to 100", job.attempts));
  }
  job.run.common.execution.validate();
}

}  // namespace vantage::apps
