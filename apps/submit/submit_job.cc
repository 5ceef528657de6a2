#include "apps/submit/submit_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
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
#include "engine/error.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/json_text.h"
#include "engine/io/files/remote_files.h"
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
  refuse_if(job.run.shard.has_value(), "shard",
            "each task has its own; --shards is the number of tasks");
  if (job.run.input.is_stream()) {
    throw UsageError("a stream cannot be submitted: tasks read files, expected one");
  }
  refuse_if(writes_stream(job.run), "output -", "tasks write a folder, expected one");
  refuse_if(job.run.show, "show", "tasks have no screen");
  refuse_if(job.run.dry_run, "dry-run", "'vantage run' prints the plan, --no-submit the scripts");
  refuse_if(!job.run.common.report.empty(), "report",
            "each task writes its own: DIR/.vantage/slurm/report-1.json and so on");
  refuse_if(job.no_submit && (job.run.overwrite || job.run.force),
            job.run.force ? "force" : "overwrite", "--no-submit does not change the folder");
  job.slurm.validate();
}

/// Paths become absolute because tasks start in another folder.
void make_paths_absolute(SubmitJob& job) {
  PairSourceOptions& input = job.run.input;
  std::vector<std::string*> paths = {&input.left,
                                     &input.right,
                                     &input.stereo,
                                     &input.pairs,
                                     &input.sequence,
                                     &job.run.calibration,
                                     &job.run.unrectified,
                                     &job.run.poses,
                                     &job.run.views.poses.file,
                                     &job.run.views.path.file,
                                     &job.run.output,
                                     &job.slurm.program};
  for (std::string& source : input.more) {
    paths.push_back(&source);
  }
  for (std::string* path : paths) {
    if (!path->empty() && !is_address(*path)) {
      *path = fs::absolute(*path).lexically_normal().string();
    }
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

void require_work_for_all(const SlurmOptions& slurm, const FrameSelection& selection) {
  const FrameRange frames = selection.all();
  const int chunks = chunk_count(selection);
  if (slurm.shards > chunks) {
    throw UsageError(fmt::format(
        "--shards is {}, expected at most {}: there are {} frames in chunks of {} (--chunk-frames)",
        slurm.shards, chunks, frames.count(), selection.chunk_frames));
  }
}

/// Unless --chunk-frames is given, makes chunks small enough for every task to have one.
void divide_for_all(const Settings& settings, SubmitJob& job) {
  FrameSelection selection;
  const std::unique_ptr<PairSource> pairs = open_pair_source(job.run.input);
  selection.frame_count = pairs->pair_count();
  selection.frames = selected_pairs(job.run, *pairs);
  selection.chunk_frames = job.run.sequence.chunk_frames;
  const int share = selection.all().empty() ? 0 : selection.all().count() / job.slurm.shards;
  if (settings.is_set("chunk-frames") || share < 1 || chunk_count(selection) >= job.slurm.shards) {
    return;
  }
  job.run.sequence.chunk_frames = share;
  if (!job.run.common.quiet) {
    tell("submit: --chunk-frames is {}, so that all {} tasks have frames\n", share,
         job.slurm.shards);
  }
}

/// The one-line message of a Slurm program that failed.
std::string message_of(const ProgramResult& result) {
  std::string text = result.err.empty() ? result.out : result.err;
  std::ranges::replace(text, '\n', ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  return text.empty() ? fmt::format("exit code {}", result.exit_code) : text;
}

void require_slurm() {
  if (!program_exists("sbatch")) {
    throw Error(
        "sbatch is not in the PATH, expected Slurm's programs (Debian: slurm-client); --no-submit "
        "only writes the job scripts");
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
  const ProgramResult result = run_program(command);
  if (result.exit_code != 0) {
    throw Error(fmt::format("{}: refused by Slurm: {}", script.string(), message_of(result)));
  }
  std::string job = result.out.substr(0, result.out.find_first_of(";\n"));
  if (job.empty() ||
      !std::ranges::all_of(job, [](char letter) { return letter >= '0' && letter <= '9'; })) {
    throw Error(
        fmt::format("sbatch printed '{}', expected a job number", quotable(message_of(result))));
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

SlurmRun to_slurm_run(const SubmitJob& job) {
  RunJob all_shards;
  all_shards.frames = job.run.frames;
  return {.folder = job.run.output,
          .program = job.slurm.program.empty() ? path_of_this_program() : job.slurm.program,
          .threads_from_slurm = !job.run.common.execution.threads,
          .part_prefix = job.run.frames ? RunSession::part_name(all_shards) + "-" : ""};
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
      "  again    vantage submit --config {}\n",
      jobs.array, job.slurm.shards, jobs.merge, job.run.output, jobs.array, jobs.merge,
      shell_word(folder.string()), jobs.array, jobs.merge, jobs.array, jobs.merge,
      shell_word((folder / "submit.toml").string()));
}

void print_how_to_submit(const fs::path& folder) {
  fmt::print("not submitted; submit with:\n  job=$(sbatch --parsable {})\n  sbatch {} {}\n",
             shell_word((folder / "array.sh").string()), fmt::join(dependency_on("$job"), " "),
             shell_word((folder / "merge.sh").string()));
}

}  // namespace

int run_submit(SubmitJob& job, const Settings& settings) {
  check(job);
  complete(job.run, settings);
  make_paths_absolute(job);
  divide_for_all(settings, job);
  require_folder_for_scripts(job.run.output);
  const fs::path folder = slurm_folder(job.run.output);
  const JournalOpening opening = take_opening(job.run);
  const bool no_submit = std::exchange(job.no_submit, false);
  const bool quiet = std::exchange(job.run.common.quiet, false);
  // The settings of the run alone, bound to the same fields.
  Settings run_settings("run", "");
  add_run_settings(run_settings, job.run);
  const std::string submit_file = to_toml(settings);
  const std::string job_file = to_toml(run_settings);

  RunReport report(settings.command(), settings.values());
  force_instruction_set(job.run.common.isa);
  const RunSession session = open_run(job.run, run_settings, report);
  require_work_for_all(job.slurm, session.selection);
  if (!no_submit) {
    require_slurm();
    require_none_in_queue(folder);
    prepare_journal(job.run, session, opening);
  }
  if (!job.slurm.cpus) {
    job.slurm.cpus = job.run.common.execution.threads;
  }
  const SlurmRun run = to_slurm_run(job);
  make_folder(folder);
  write_text_file(folder / "submit.toml", submit_file);
  write_text_file(folder / "job.toml", job_file);
  write_text_file(folder / "array.sh", array_script(job.slurm, run));
  write_text_file(folder / "merge.sh", merge_script(job.slurm, run));
  if (no_submit) {
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
