#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/process/child_process.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/run/run_session.h"
#include "apps/run/stream_run.h"
#include "apps/settings/command_line.h"
#include "apps/submit/slurm_engine.h"
#include "apps/submit/submit_job.h"
#include "apps/submit/submit_program.h"
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/json_text.h"
#include "engine/options/setting_value.h"
#include "engine/quoted_text.h"
#include "engine/sequence/journal/leftovers.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/simd.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

struct SubmittedJobs {
  std::string array;
  std::string merge;
};

/// Refuses options that would mean something else in every task, and says what to use.
void check(const SubmitJob& job) {
  const auto refuse_if = [](bool given, const char* option, const char* instead) {
    if (given) {
      throw UsageError(fmt::format("--{} cannot be submitted: {}", option, instead));
    }
  };
  refuse_if(job.batch.run.shard.has_value(), "shard",
            "each task has its own; --shards is the number of tasks");
  if (job.batch.run.input.is_stream()) {
    throw UsageError("a stream cannot be submitted: tasks read files, expected one");
  }
  refuse_if(writes_stream(job.batch.run), "output -", "tasks write a folder, expected one");
  refuse_if(job.batch.run.show, "show", "tasks have no screen");
  refuse_if(job.batch.run.dry_run, "dry-run", "'vantage run' prints the plan");
  refuse_if(!job.batch.run.common.report.empty(), "report",
            "each task writes its own: DIR/.vantage/slurm/report-1.json and so on");
  refuse_if(!job.options.go && (job.batch.run.overwrite || job.batch.run.force),
            job.batch.run.force ? "force" : "overwrite", "the folder is not changed without --go");
  if (job.options.shards == 0) {
    throw UsageError("--shards is missing, expected --shards N");
  }
}

/// Tasks always continue the run, whatever the submission starts with.
JournalOpening take_opening(RunJob& job) {
  const bool overwrite = std::exchange(job.overwrite, false);
  const bool force = std::exchange(job.force, false);
  job.resume = false;
  return overwrite ? JournalOpening::kOverwrite
         : force   ? JournalOpening::kForce
                   : JournalOpening::kResume;
}

/// Number of chunks that the run consists of.
int chunk_count(const FrameSelection& selection) {
  const FrameRange frames = selection.all();
  return frames.empty() ? 0
                        : (frames.end - 1) / selection.chunk_frames -
                              frames.first / selection.chunk_frames + 1;
}

void require_work_for_all(int shards, const FrameSelection& selection) {
  const FrameRange frames = selection.all();
  const int chunks = chunk_count(selection);
  if (shards > chunks) {
    throw UsageError(fmt::format(
        "--shards is {}, expected at most {}: there are {} frames in chunks of {} (--chunk-frames)",
        shards, chunks, frames.count(), selection.chunk_frames));
  }
}

/// Unless --chunk-frames is given, makes chunks small enough for every task to have one.
void divide_for_all(const Settings& settings, SubmitJob& job) {
  FrameSelection selection;
  const std::unique_ptr<PairSource> pairs = open_pair_source(job.batch.run.input);
  selection.frame_count = pairs->pair_count();
  selection.frames = selected_pairs(job.batch.run, *pairs);
  selection.chunk_frames = job.batch.run.sequence.chunk_frames;
  const int share = selection.all().empty() ? 0 : selection.all().count() / job.options.shards;
  if (settings.is_set("chunk-frames") || share < 1 ||
      chunk_count(selection) >= job.options.shards) {
    return;
  }
  job.batch.run.sequence.chunk_frames = share;
  if (!job.batch.run.common.quiet) {
    tell("submit: --chunk-frames is {}, so that all {} tasks have frames\n", share,
         job.options.shards);
  }
}

/// Two job arrays on one folder would do all work twice.
void require_none_in_queue(const fs::path& folder) {
  const fs::path record = folder / "submitted.json";
  std::error_code ignored;
  if (!fs::exists(record, ignored)) {
    return;  // nothing has been submitted yet
  }
  const SettingValue jobs = read_json_file(record);
  if (!jobs.is_object()) {
    throw Error(fmt::format("{}: damaged, expected job numbers", record.string()));
  }
  for (const char* const name : {"array_job", "merge_job"}) {
    const std::string job = jobs.value(name, "none");
    const ProgramResult queue = run_program({"squeue", "--noheader", "--jobs=" + job});
    if (queue.exit_code == 0 && !queue.out.empty()) {
      throw Error(fmt::format(
          "{}: job {} of an earlier submission is still in the queue; 'scancel {}' ends it",
          folder.string(), job, job));
    }
  }
}

/// Hands a job script to Slurm and returns the job's id.
std::string submit(const std::vector<std::string>& options, const fs::path& script) {
  std::vector<std::string> command = {"sbatch", "--parsable"};
  command.insert(command.end(), options.begin(), options.end());
  command.push_back(script.string());
  const std::string answer = output_of_submission(command);
  std::string job = answer.substr(0, answer.find_first_of(";\n"));
  if (job.empty() ||
      !std::ranges::all_of(job, [](char letter) { return letter >= '0' && letter <= '9'; })) {
    throw Error(fmt::format("sbatch printed '{}', expected a job number", quotable(answer)));
  }
  return job;
}

/// Refuses the folder of another run here, instead of in every task.
void prepare_journal(const RunJob& run, const RunSession& session, JournalOpening opening) {
  const SequenceLayout layout(run.output, run.sequence);
  if (opening != JournalOpening::kOverwrite) {
    require_no_foreign_files(layout);
  }
  if (opening != JournalOpening::kResume || RunJournal::is_present(layout.journal_folder())) {
    const RunJournal journal(layout.journal_folder(), session.identity, opening, "submit");
  }
}

ArrayJob to_array_job(const SubmitJob& job, const fs::path& folder) {
  ArrayJob array = job.options.requests;
  array.drain_s = job.options.drain_s_or_default();
  array.name = job_name(job.batch.run.output);
  array.folder = folder;
  array.tasks = job.options.shards;
  if (!array.cores) {
    array.cores = job.batch.run.common.execution.threads;
  }
  return array;
}

/// Task i makes shard i, with as many threads as it has processors.
TaskWork work_of_shards(const SubmitJob& job, const std::string& program) {
  RunJob all_shards;
  all_shards.frames = job.batch.run.frames;
  const std::string part_prefix =
      job.batch.run.frames ? RunSession::part_name(all_shards) + "-" : "";
  std::string command = shell_word(program) +
                        " run \"$folder/job.toml\" --shard \"$task/$tasks\" --resume --progress "
                        "plain --report \"$folder/report-$task.json\"";
  if (!job.batch.run.common.execution.threads) {
    command += " --threads \"${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-1}}\"";
  }
  return {.comment = fmt::format("Task i makes shard i/{} of a run.", job.options.shards),
          .command = command,
          .finished_parts =
              fmt::format("$folder/../frames-{}$task-of-$tasks.jsonl", shell_word(part_prefix)),
          .part_line = "{",
          .skipped_exit_code = kExitDone};  // the merge starts after 0 only
}

std::vector<std::string> dependency_on(const std::string& array) {
  return {"--dependency=afterok:" + array, "--kill-on-invalid-dep=yes"};
}

SubmittedJobs submit_both(const fs::path& folder) {
  SubmittedJobs jobs;
  jobs.array = submit({}, folder / "array.sh");
  try {
    jobs.merge = submit(dependency_on(jobs.array), folder / "merge.sh");
    const SettingValue record = {{"array_job", jobs.array}, {"merge_job", jobs.merge}};
    write_text_file(folder / "submitted.json", record.dump() + "\n");
  } catch (...) {
    run_program({"scancel", jobs.array, jobs.merge.empty() ? jobs.array : jobs.merge});
    throw;
  }
  return jobs;
}

void print_how_to_follow(const fs::path& folder, const SubmittedJobs& jobs, const SubmitJob& job) {
  fmt::print(
      "job {}: {} tasks, then job {}: merge -> {}\n"
      "  queue    squeue --array --jobs={},{}\n"
      "  logs     tail -n +1 -F {}/*.log\n"
      "  history  sacct --jobs={},{}\n"
      "  cancel   scancel {} {}\n"
      "  again    vantage submit --go --config {}\n",
      jobs.array, job.options.shards, jobs.merge, job.batch.run.output, jobs.array, jobs.merge,
      shell_word(folder.string()), jobs.array, jobs.merge, jobs.array, jobs.merge,
      shell_word((folder / "submit.toml").string()));
}

void print_how_to_submit(const fs::path& folder) {
  fmt::print(
      "not submitted; submit with --go, or:\n  job=$(sbatch --parsable {})\n  sbatch {} {}\n",
      shell_word((folder / "array.sh").string()), fmt::join(dependency_on("$job"), " "),
      shell_word((folder / "merge.sh").string()));
}

void write_scripts(const SubmitJob& job, const fs::path& folder) {
  const std::string program =
      job.options.program.empty() ? path_of_this_program() : job.options.program;
  const ArrayJob array = to_array_job(job, folder);
  // For a partial run, merge must ignore frames outside the selection.
  const std::string merge =
      fmt::format("exec {} merge{} {}", shell_word(program),
                  job.batch.run.frames ? " --partial" : "", shell_word(job.batch.run.output));
  write_text_file(folder / "array.sh",
                  slurm_array_script(array, job.options, work_of_shards(job, program)));
  write_text_file(folder / "merge.sh", slurm_job_script(array, job.options, "merge", merge));
}

}  // namespace

int submit_divided_run(SubmitJob& job, const Settings& settings) {
  check(job);
  complete(job.batch.run, settings);
  divide_for_all(settings, job);
  const fs::path folder = slurm_folder(job.batch.run.output);
  require_folder_for_slurm(folder);
  const JournalOpening opening = take_opening(job.batch.run);
  const bool go = std::exchange(job.options.go, false);
  const bool quiet = std::exchange(job.batch.run.common.quiet, false);
  // The settings of the run alone, bound to the same fields.
  Settings run_settings("run", "");
  add_run_settings(run_settings, job.batch.run);
  const std::string submit_file = to_toml(settings);
  const std::string job_file = to_toml(run_settings);

  RunReport report(settings.command(), settings.values());
  force_instruction_set(job.batch.run.common.isa);
  const RunSession session = open_run(job.batch.run, run_settings, report);
  require_work_for_all(job.options.shards, session.selection);
  if (go) {
    require_submitting_program("sbatch");
    require_none_in_queue(folder);
    prepare_journal(job.batch.run, session, opening);
  }
  make_folder(folder);
  write_text_file(folder / "submit.toml", submit_file);
  write_text_file(folder / "job.toml", job_file);
  write_scripts(job, folder);
  if (!go) {
    print_how_to_submit(folder);
    return kExitDone;
  }
  const SubmittedJobs jobs = submit_both(folder);
  if (!quiet) {
    print_how_to_follow(folder, jobs, job);
  }
  return kExitDone;
}

}  // namespace vantage::apps
