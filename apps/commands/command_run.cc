#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "apps/commands/commands.h"
#include "apps/process/interrupt.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/run_report.h"
#include "apps/run/film_reports.h"
#include "apps/run/resumed_run.h"
#include "apps/run/run_forecast.h"
#include "apps/run/run_results.h"
#include "apps/run/run_session.h"
#include "apps/run/run_settings.h"
#include "apps/run/run_window.h"
#include "apps/run/stream_run.h"
#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/image/memory_use.h"
#include "engine/io/images/picture_window.h"
#include "engine/sequence/journal/leftovers.h"
#include "engine/sequence/journal/sequence_join.h"
#include "engine/simd.h"

namespace vantage::apps {
namespace {

JournalOpening opening_of(const RunJob& job) {
  return job.overwrite ? JournalOpening::kOverwrite
         : job.force   ? JournalOpening::kForce
         : job.resume  ? JournalOpening::kResume
                       : JournalOpening::kNew;
}

/// Computed once for all parts of the run and every resumption. Empty when interrupted.
std::optional<ShotTable> find_shots(const RunJob& job, RunSession& session,
                                    const SequenceLayout& layout, Execution& execution,
                                    RunReport& report) {
  const std::filesystem::path path = layout.journal_folder() / kShotsFile;
  if (auto stored = read_shot_table(path)) {
    return stored;
  }
  Progress progress("run: looking for shots", "frames", job.shown_progress());
  SurveyHooks hooks;
  hooks.in_flight = session.memory.in_flight;
  hooks.progress = [&](const SurveyProgress& now) {
    progress.update(now.frames_done, now.frames_total, 0);
  };
  hooks.stop = &interrupt_flag();
  if (session.rectifier) {
    hooks.prepare = [&](FramePair& pair) { session.rectify(pair, execution); };
  }
  auto shots = report.timed_compute("shots", [&] {
    return survey_shots(*session.pairs, 0, session.selection.frame_count, job.sequence, hooks,
                        execution);
  });
  if (!shots) {
    return std::nullopt;
  }
  return keep_shot_table(path, *shots);
}

/// Joins the videos and writes what is of all frames, once those of the folder are done. Returns
/// why videos have no sound, as join_segments() does.
std::string finish_if_whole(const RunJob& job, const RunSession& session,
                            const SequenceLayout& layout, const SequenceReport& sequence,
                            RunJournal& journal, RunReport& report) {
  const bool has_report = job.sequence.saves(SequenceOutput::kComfort);
  // A stream is never continued.
  const bool is_unfinished = sequence.interrupted && !job.input.is_stream();
  if (job.shard || is_unfinished || (!layout.has_videos() && !has_report)) {
    return "";
  }
  const DeliveredFrames delivered(layout);
  const std::vector<FrameRange> lost = delivered.missing(session.selection.all());
  if (!lost.empty() && !job.input.is_stream()) {
    throw Error(fmt::format("{}: frames {} are not as they were written, `resume` makes them again",
                            layout.folder().string(), to_string(lost)));
  }
  const FrameRange frames = contiguous_frames(delivered, session.selection.frame_count);
  const std::string sound_problem = report.timed_file_access("join", [&] {
    return join_segments(job.sequence, layout, session.identity, frames,
                         sequence.frames + sequence.pictures_again > 0, journal);
  });
  const auto comfort = write_film_reports(job.sequence, layout, frames, journal);
  if (comfort && !job.common.quiet) {
    print_comfort("run", *comfort, layout);
  }
  return sound_problem;
}

}  // namespace

int command_run(const Arguments& arguments) {
  RunJob job;
  Settings settings("run", "Computes disparity maps and new views of a sequence of stereo pairs.");
  settings.take_job_file();
  add_run_settings(settings, job);
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  take_up_run(arguments, settings, job);
  complete(job, settings);
  RunReport report(settings.command(), reported_settings(settings, job.sequence.match));
  report.start_trace(job.common.trace);
  force_instruction_set(job.common.isa);
  if (job.show) {
    require_display();
  }
  RunSession session = open_run(job, settings, report);
  // A live stream is read by a thread of its own, which may wait for a sender who waits for us.
  const std::shared_ptr<void> end_of_reading(nullptr, [&](void*) {
    if (job.input.live) {
      request_end();
    }
  });
  const std::string plan = describe_plan(job, session);
  if (!job.common.quiet && !job.dry_run) {
    tell("{}", plan);
  }
  ExecutionOptions execution_options = session.execution;
  execution_options.chain_memory_bytes = session.memory.chain_bytes;
  Execution execution(execution_options);
  report.set_execution(execution);
  tell_threads(execution, job.common, report);
  report.set_tuning(session.tuning.report, session.tuning.summary);
  if (job.dry_run) {
    fmt::print("{}{}", plan, forecast_run(job, session, execution, report));
    report.write(job.common.report);
    return kExitDone;
  }

  if (writes_stream(job)) {
    return run_to_stream(job, session, execution, report);
  }
  const SequenceLayout layout(job.output, job.sequence);
  if (!job.overwrite) {
    require_no_foreign_files(layout);
  }
  RunJournal journal(layout.journal_folder(), session.identity, opening_of(job),
                     RunSession::part_name(job));
  const std::atomic<bool>& interrupted = interrupt_flag();
  std::optional<ShotTable> shots;
  if (job.sequence.needs_shots() && !job.input.is_stream()) {
    shots = find_shots(job, session, layout, execution, report);
    if (!shots) {
      if (!job.common.quiet) {
        tell("run: interrupted while looking for shots, --resume starts with that again\n");
      }
      return kExitInterrupted;
    }
  }
  SequenceReport sequence;
  {
    Progress progress("run", "frames", job.shown_progress());
    SequenceRun run =
        session.run(job, *session.pairs, shots ? &*shots : nullptr, session.memory.in_flight);
    run.stop = &interrupted;
    run.on_progress = [&](const SequenceProgress& now) {
      progress.update(now.frames_done, now.frames_total, now.cells);
    };
    sequence = beside_window(job, std::move(run), [&](const SequenceRun& shown) {
      return SequenceRunner(job.sequence, execution).run(shown, layout, journal);
    });
  }
  if (sequence.shots) {
    keep_shot_table(layout.journal_folder() / kShotsFile, *sequence.shots);
  }
  add_scratch_use(execution, sequence.memory);
  report.set_memory(sequence.memory);
  const std::string sound_problem =
      finish_if_whole(job, session, layout, sequence, journal, report);
  fill_report(job, session, sequence, DeliveredFrames(layout), sound_problem, report);
  tell_remarks(remarks_of(job, sequence), job.common, report);
  report.write(job.common.report);
  if (!job.common.quiet) {
    print_sound_problem("run", sound_problem);
    print_summary(job, session, sequence, report.wall_seconds());
    report.print_summary();
  }
  if (sequence.interrupted) {
    return kExitInterrupted;
  }
  if (sequence.stream_problem) {
    throw Error(fmt::format("{}; {} frame{} before it {} done", *sequence.stream_problem,
                            sequence.frames, sequence.frames == 1 ? "" : "s",
                            sequence.frames == 1 ? "is" : "are"));
  }
  const Pairing pairing = session.pairs->pairing();
  if (pairing.by == PairBy::kOrder && !pairing.is_whole() && RunSession::part_name(job) == "all") {
    // All frames with a partner are done, but which frames are missing is not known.
    if (!job.keep_going) {
      throw Error(fmt::format("all {} pairs are done, but {}", session.selection.frame_count,
                              fmt::join(session.pairs->remarks(), "; ")));
    }
    return kExitSkipped;
  }
  return sequence.skipped.empty() ? kExitDone : kExitSkipped;
}

}  // namespace vantage::apps
