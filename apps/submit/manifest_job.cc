#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "apps/commands/commands.h"
#include "apps/process/child_process.h"
#include "apps/submit/engine_table.h"
#include "apps/submit/local_workers.h"
#include "apps/submit/planned_requests.h"
#include "apps/submit/submit_job.h"
#include "apps/submit/submit_program.h"
#include "apps/submit/task_script.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/quoted_text.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

/// Options of a run that a task gets from its submission, or that are for people who look on.
constexpr std::array<std::string_view, 4> kNotOfTasks = {"output", "threads", "quiet", "progress"};
/// Of what a task may use, the budget of its plan.
constexpr double kBudgetOfMemory = 0.8;

void check_manifest_job(const SubmitJob& job, const Settings& settings) {
  settings.refuse_idle({"shards"}, "with a manifest: --tasks is the number of tasks");
  settings.refuse_idle({"dry-run", "report", "resume"}, "in a submission: 'vantage batch' has it");
  check_batch(job.batch, settings);
}

/// The words that give a setting its present value.
void append_words(const Setting& setting, std::vector<std::string>& words) {
  for (const SettingValue& value : to_list(setting.get())) {
    if (setting.kind != ValueKind::kTruth) {
      words.push_back(fmt::format("--{}={}", setting.name,
                                  value.is_string() ? value.get<std::string>() : value.dump()));
    } else if (value == true) {
      words.push_back("--" + setting.name);
    }
  }
}

/// The command that all tasks are given.
std::vector<std::string> task_command(SubmitJob& job, const Settings& settings,
                                      const EngineEntry& engine, const ArrayJob& array) {
  const std::string program = !job.options.program.empty() ? job.options.program
                              : engine.shares_files        ? path_of_this_program()
                                                           : "vantage";
  std::vector<std::string> words = {program, "batch", job.batch.manifest, "--output",
                                    job.batch.run.output};
  Settings of_batch("batch", "");
  add_run_settings(of_batch, job.batch.run);
  add_job_settings(of_batch, job.batch);
  for (const Setting& setting : of_batch.all()) {
    if (settings.is_set(setting.name) &&
        std::ranges::find(kNotOfTasks, setting.name) == kNotOfTasks.end()) {
      append_words(setting, words);
    }
  }
  if (!settings.is_set("memory")) {
    const double budget = kBudgetOfMemory * static_cast<double>(mebibytes(*array.memory_bytes));
    words.push_back(fmt::format("--memory={}M", std::max(1, static_cast<int>(budget))));
  }
  words.push_back(fmt::format("--threads={}", *array.cores));
  words.push_back(fmt::format("--grace={}s", std::max(1, array.drain_s * 3 / 4)));
  if (engine.engine == BatchEngine::kLocal) {
    words.emplace_back("--worker");
  } else {
    words.emplace_back(array.tasks == 1 ? "--index=1/1" : "--index=auto");
  }
  return words;
}

/// Where scripts and logs go: to the results, or where these are not on this machine, here.
fs::path job_folder(const SubmitJob& job, const EngineEntry& engine, const std::string& name) {
  const fs::path output = job.batch.run.output;
  return engine.shares_files && output.is_absolute() ? output / ".vantage" / "submit"
                                                     : fs::absolute(name);
}

void require_printable(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (printable(word) != word) {
      throw UsageError(
          fmt::format("'{}' has control characters or no UTF-8, which files of engines "
                      "cannot hold",
                      quotable(word)));
    }
  }
}

std::string summary_of(const ArrayJob& array, const EngineEntry& engine) {
  return fmt::format(
      "{}: tasks {}, processors of each {}, memory {} MiB, {} -> {}\n", engine.name, array.tasks,
      *array.cores, mebibytes(*array.memory_bytes),
      array.time_limit_s ? "at most " + duration_text(*array.time_limit_s) : "no time limit",
      array.folder.string());
}

int print_commands(const Submission& submission) {
  fmt::print("not submitted; submit with --go, or:\n");
  for (const std::vector<std::string>& command : submission.commands) {
    fmt::print("  {}\n", shell_line(command));
  }
  return kExitDone;
}

int hand_over(const ArrayJob& array, const Submission& submission, const EngineEntry& engine) {
  if (engine.program.empty()) {
    return run_workers(array, submission.commands);
  }
  for (const std::vector<std::string>& command : submission.commands) {
    fmt::print("{}", output_of_submission(command));
  }
  return kExitDone;
}

}  // namespace

int submit_manifest(SubmitJob& job, const Settings& settings) {
  check_manifest_job(job, settings);
  const EngineEntry& engine = engine_entry(job.options.engine);
  ArrayJob array = job.options.requests;
  array.drain_s = job.options.drain_s_or_default();
  array.name = job_name(job.batch.run.output);
  array.folder = job_folder(job, engine, array.name);
  plan_requests(job, settings, array);
  if (engine.engine == BatchEngine::kLocal) {
    array.tasks = std::min(array.tasks,
                           workers_that_fit(*array.cores, *array.memory_bytes, array.concurrent));
  }
  array.command = task_command(job, settings, engine, array);
  require_printable(array.command);
  const Submission submission = engine.write(array, job.options);
  if (job.options.go && !engine.program.empty()) {
    require_submitting_program(engine.program);
  }
  make_folder(array.folder);
  for (const auto& [name, text] : submission.files) {
    write_text_file(array.folder / name, text);
  }
  if (!job.batch.run.common.quiet) {
    fmt::print("{}", summary_of(array, engine));
  }
  return job.options.go ? hand_over(array, submission, engine) : print_commands(submission);
}

}  // namespace vantage::apps
