#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/run/film_reports.h"
#include "apps/run/resumed_run.h"
#include "apps/run/run_results.h"
#include "apps/run/run_session.h"
#include "apps/run/run_settings.h"
#include "apps/run/verified_run.h"
#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/journal/sequence_join.h"

namespace vantage::apps {
namespace {

struct MergeJob {
  std::string folder;
  bool partial = false;
  bool verify = false;
  bool no_sound = false;
  std::string report;
  bool quiet = false;
};

void add_merge_settings(Settings& settings, MergeJob& job) {
  settings.positional("dir", job.folder, "Folder of the run").required = true;
  settings.flag("partial", job.partial,
                "Join the existing frames, if there are no gaps between them");
  settings.flag("no-sound", job.no_sound, "Do not copy the sound of the input");
  settings.flag("verify", job.verify,
                "Check joined videos and reports as well before anything is written, not only what "
                "is joined");
  settings.path("report", job.report, "FILE", "Write a JSON report");
  settings.flag("quiet", job.quiet, "Print errors only");
  settings.set_short_help({}, {"vantage merge results", "vantage merge results --partial",
                               "vantage merge results --verify --report merge.json"});
}

[[noreturn]] void fail_incomplete(const std::string& folder, const SequenceLayout& layout,
                                  FrameRange all, const std::vector<FrameRange>& missing) {
  int count = 0;
  for (const FrameRange range : missing) {
    count += range.count();
  }
  const bool resumes_all = resumed_part(layout.journal_folder()).is_all();
  throw Error(fmt::format(
      "{}: {} of {} frames are missing ({}), expected all; 'vantage run -o {} --resume{}' computes "
      "them{}",
      folder, count, all.count(), to_string(missing), folder, resumes_all ? "" : " --frames all",
      resumes_all ? "" : ", --partial leaves them out"));
}

}  // namespace

int command_merge(const Arguments& arguments) {
  MergeJob job;
  Settings settings("merge",
                    "Checks that all parts of a run are complete, and joins their videos.");
  add_merge_settings(settings, job);
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  FileChecks files(settings);
  files.add_output(job.report, "--report", OutputKind::kText);
  RunReport report(settings.command(), settings.values());
  RunJob run;
  const RunIdentity identity = read_run(job.folder, run, files);
  run.sequence.sound = run.sequence.sound && !job.no_sound;
  const SequenceLayout layout(job.folder, run.sequence);
  if (job.verify) {
    const RunVerification verification = report.timed_file_access("verify", [&] {
      return verify_with_progress(layout, settings.command(),
                                  job.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
    });
    if (verification.interrupted) {
      return kExitInterrupted;
    }
    if (!verification.damaged.empty()) {
      throw Error(describe_damage(verification, job.folder));
    }
  }
  const DeliveredFrames delivered(layout);
  const FrameRange all = input_frames(identity, delivered);
  const std::vector<FrameRange> missing = delivered.missing(all);
  FrameRange frames = all;
  if (job.partial || identity.is_stream()) {
    frames = contiguous_frames(delivered, all.end);
    if (frames.empty()) {
      throw Error(fmt::format("{}: frames {} are missing, expected frames without a gap",
                              job.folder, to_string(missing)));
    }
  } else if (!missing.empty()) {
    fail_incomplete(job.folder, layout, all, missing);
  }
  const ProgressStyle progress = job.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto;
  if (!report.timed_file_access("check", [&] {
        return require_unchanged_frames(layout, delivered, frames, settings.command(), progress);
      })) {
    return kExitInterrupted;
  }
  std::string sound_problem;
  {
    // The part name excludes a second merge at the same time, but not a run.
    RunJournal journal(layout.journal_folder(), identity, JournalOpening::kResume, "merge");
    report.timed_file_access("join", [&] {
      sound_problem = join_segments(run.sequence, layout, identity, frames, true, journal);
    });
    const auto comfort = write_film_reports(run.sequence, layout, frames, journal);
    if (comfort && !job.quiet) {
      print_comfort("merge", *comfort, layout);
    }
  }
  const std::vector<int> skipped = delivered.skipped(frames);
  SettingValue results = {{"frames", frames.count() - static_cast<int>(skipped.size())},
                          {"first_frame", frames.first},
                          {"skipped", skipped},
                          {"sound_problem", sound_problem}};
  report.set_results(std::move(results));
  report.write(job.report);
  if (!job.quiet) {
    print_sound_problem("merge", sound_problem);
    tell("merge: {} holds {}{}\n", job.folder,
         frames == all ? fmt::format("all {} frames", all.count())
                       : fmt::format("frames {} of {}", to_string({frames}), all.count()),
         skipped.empty() ? "" : fmt::format(", but {} of them failed", skipped.size()));
  }
  return skipped.empty() ? kExitDone : kExitSkipped;
}

}  // namespace vantage::apps
