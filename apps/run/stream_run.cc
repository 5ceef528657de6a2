#include "apps/run/stream_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include "apps/commands/commands.h"
#include "apps/process/interrupt.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/run/run_results.h"
#include "apps/run/run_window.h"
#include "engine/error.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/stream_runner.h"

namespace vantage::apps {
namespace {

constexpr const char* kStream = "-";

}  // namespace

bool writes_stream(const RunJob& job) { return job.output == kStream; }

void check_stream(const RunJob& job) {
  if (!writes_stream(job)) {
    return;
  }
  const SequenceOptions& options = job.sequence;
  const SequenceLayout layout(job.output, options);
  if (options.saves(SequenceOutput::kComfort) || layout.streams().size() != 1 ||
      !is_picture(layout.streams().front().output)) {
    throw UsageError(
        "--output is -, expected --save with one output of pictures: preview, views, stereo, "
        "depth-video, unmatched, right-unmatched, holes, sources or cyclopean-occlusion");
  }
  if (options.needs_matched_shots() || options.search_scope == SearchScope::kShot ||
      options.depth_scale.scope == DepthVideoScale::Scope::kShot) {
    throw UsageError(
        "an option is per shot and --output is -, expected no shots: they need the whole input "
        "first");
  }
}

int run_to_stream(const RunJob& job, const RunSession& session, Execution& execution,
                  RunReport& report) {
  if (session.identity.times_at(job.sequence.frame_rate) != nullptr && !job.common.quiet) {
    tell(
        "run: warning: the input has a variable frame rate, which y4m and rawvideo cannot hold: "
        "the output has {} frames per second throughout; a video in a folder (--output DIR) keeps "
        "the times\n",
        to_string(job.sequence.frame_rate));
  }
  const SequenceLayout layout(job.output, job.sequence);
  StreamedVideoWriter writer(StreamOutput(STDOUT_FILENO, &interrupt_flag()), job.stream_format,
                             job.sequence.frame_rate,
                             film_format_of(layout.streams().front().output, job.sequence.film));
  SequenceReport sequence;
  {
    Progress progress("run", "frames",
                      job.input.is_stream() ? ProgressStyle::kNone : job.shown_progress());
    SequenceRun run = session.run(job, *session.pairs, nullptr, session.memory.in_flight);
    run.frame_size = session.shape.source;
    run.stop = &interrupt_flag();
    run.on_progress = [&](const SequenceProgress& now) {
      progress.update(now.frames_done, now.frames_total, now.cells);
    };
    sequence = beside_window(job, std::move(run), [&](const SequenceRun& shown) {
      return run_stream(job.sequence, shown, writer, execution);
    });
  }
  report.set_memory(sequence.memory);
  report.add_compute_seconds(sequence.compute_seconds);
  report.add_cells(sequence.cells);
  if (sequence.frames > 0) {
    report.set_plan(sequence.plan);
  }
  SettingValue results = {{"frames", sequence.frames},
                          {"skipped", sequence.skipped.size()},
                          {"interrupted", sequence.interrupted},
                          {"width_px", sequence.width_px},
                          {"height_px", sequence.height_px},
                          {"frames_per_second_of_video", to_string(job.sequence.frame_rate)}};
  if (sequence.live) {
    results["live"] = live_values(*sequence.live);
  }
  report.set_results(std::move(results));
  tell_remarks(remarks_of(job, sequence), job.common, report);
  report.write(job.common.report);
  if (!job.common.quiet) {
    for (const FrameRemark& skipped : sequence.skipped) {
      tell("run: skipped frame {}: {}\n", skipped.frame, skipped.text);
    }
    tell("run: {} frame{} of {}x{} pixels -> standard output{}\n", sequence.frames,
         sequence.frames == 1 ? "" : "s", sequence.width_px, sequence.height_px,
         sequence.interrupted ? " (interrupted)" : "");
    print_live(sequence);
    if (!sequence.map_shares.empty()) {
      tell("run: {}\n", to_text(mean_shares(sequence)));
    }
  }
  return sequence.interrupted       ? kExitInterrupted
         : sequence.skipped.empty() ? kExitDone
                                    : kExitSkipped;
}

}  // namespace vantage::apps
