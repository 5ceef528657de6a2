#include "apps/stream_run.h"

#include <fmt/format.h>

#include <cstdio>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/progress.h"
#include "apps/tell.h"
#include "engine/error.h"
#include "engine/sequence/sequence_layout.h"
#include "engine/sequence/stream_runner.h"

namespace vantage::apps {
namespace {

constexpr const char* kStream = "-";

}  // namespace

bool is_stream(const RunJob& job) { return job.output == kStream || job.input.stereo == kStream; }

void check_stream(const RunJob& job, const Settings& settings) {
  const bool reads = job.input.stereo == kStream;
  const bool writes = job.output == kStream;
  if (!reads) {
    settings.refuse_idle({"raw-video"}, "without --stereo -");
  }
  if (!writes) {
    settings.refuse_idle({"stream-format"}, "without --output -");
  }
  if (reads && !writes) {
    throw UsageError(
        "stereo is - and output is a folder, expected --output -: what is continued must be read "
        "again; store the stream in a file first");
  }
  if (!writes) {
    return;
  }
  settings.refuse_idle({"resume", "overwrite", "force", "shard", "video", "measure-flicker", "crf",
                        "no-sound", "depth-codec", "format"},
                       "with --output -");
  const SequenceOptions& options = job.sequence;
  const SequenceLayout layout(job.output, options);
  if (options.saves(SequenceOutput::kComfort) || layout.streams().size() != 1 ||
      !is_picture(layout.streams().front().output)) {
    throw UsageError(
        "output is -, expected --save with one output of pictures: preview, views, stereo, "
        "depth-video, unmatched, right-unmatched, holes, sources or cyclopean-occlusion");
  }
  if (options.needs_matched_shots() || options.search_range_per_shot ||
      options.depth_scale.scope == DepthVideoScale::Scope::kShot) {
    throw UsageError(
        "something is per shot and output is -, expected no shots: they need the whole input "
        "first");
  }
}

int run_to_stream(const RunJob& job, const RunSession& session, Execution& execution,
                  RunReport& report) {
  StreamedVideoWriter writer(stdout, job.stream_format, job.sequence.frame_rate);
  SequenceReport sequence;
  {
    // The length of a stream is not known, so there is no share to show.
    Progress progress("run", "frames",
                      job.input.stereo == kStream ? ProgressStyle::kNone : job.shown_progress());
    SequenceRun run = session.run(job, nullptr);
    run.frame_size = session.shape.source;
    run.stop = &interrupt_flag();
    run.on_progress = [&](const SequenceProgress& now) {
      progress.update(now.frames_done, now.frames_total, now.cells);
    };
    sequence = run_stream(job.sequence, run, writer, execution);
  }
  report.set_memory(sequence.memory);
  report.add_compute_seconds(sequence.compute_seconds);
  report.add_cells(sequence.cells);
  if (sequence.frames > 0) {
    report.set_plan(sequence.plan);
  }
  report.set_results({{"frames", sequence.frames},
                      {"skipped", sequence.skipped.size()},
                      {"interrupted", sequence.interrupted},
                      {"width_px", sequence.width_px},
                      {"height_px", sequence.height_px},
                      {"frames_per_second_of_video", to_string(job.sequence.frame_rate)}});
  report.write(job.common.report);
  if (!job.common.quiet) {
    for (const FrameRemark& skipped : sequence.skipped) {
      tell("run: skipped frame {}: {}\n", skipped.frame, skipped.text);
    }
    tell("run: {} frame{} of {}x{} pixels -> standard output{}\n", sequence.frames,
         sequence.frames == 1 ? "" : "s", sequence.width_px, sequence.height_px,
         sequence.interrupted ? " (interrupted)" : "");
  }
  return sequence.interrupted       ? kExitInterrupted
         : sequence.skipped.empty() ? kExitDone
                                    : kExitSkipped;
}

}  // namespace vantage::apps
