#include "apps/run/run_forecast.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>

#include "apps/process/interrupt.h"
#include "apps/process/scratch_folder.h"
#include "apps/run/run_results.h"
#include "apps/run/stream_run.h"
#include "engine/error.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kFirstFrames = 2;
constexpr int kRangeLooks = 4;          ///< frames of which a run may look beyond the range
constexpr double kMaxFirstSeconds = 3;  ///< if these take longer, they must do
constexpr double kSeconds = 1;          ///< of the frames that are timed

/// The first `count` frames, which are run.
struct Trial {
  Trial(const RunJob& job, RunSession& session, int frames, Execution& execution) : count(frames) {
    const ScratchFolder folder(fs::temp_directory_path() / "run");
    const SequenceLayout layout(folder.path(), job.sequence);
    RunJournal journal(layout.journal_folder(), session.identity, JournalOpening::kNew, "all");
    SequenceRun run = session.run(job, *session.pairs, nullptr, session.memory.in_flight);
    const int first = session.selection.own().first;
    run.selection.shard.reset();
    run.selection.frames = FrameRange{first, first + count};
    run.stop = &interrupt_flag();
    const auto start = std::chrono::steady_clock::now();
    sequence = SequenceRunner(job.sequence, execution).run(run, layout, journal);
    seconds = seconds_since(start);
  }

  int count;
  double seconds = 0;
  SequenceReport sequence;
};

}  // namespace

std::string forecast_run(const RunJob& job, RunSession& session, Execution& execution,
                         RunReport& report) {
  const int frames = session.selection.own().count();
  const double opening_s = report.wall_seconds();
  if (frames == 0 || session.pairs->is_stream() || writes_stream(job) ||
      job.sequence.needs_shots()) {
    return "";
  }
  try {
    // It makes memory, caches and codecs ready for the other two. Their difference has no first
    // looks at the range, and the pipeline is neither filled nor emptied in it.
    Trial trial(job, session, std::min(frames, kFirstFrames), execution);
    double of_frame_s = trial.seconds / trial.count;
    const int few = std::max(kRangeLooks, session.memory.in_flight);
    const int many = std::min(frames, few + std::max(few, static_cast<int>(kSeconds / of_frame_s)));
    if (trial.seconds < kMaxFirstSeconds) {
      const int before = many < 2 * few ? 0 : few;  // of a short film all frames count
      const double before_s = before > 0 ? Trial(job, session, before, execution).seconds : 0;
      trial = Trial(job, session, many, execution);
      of_frame_s = std::max(trial.seconds - before_s, trial.seconds / many) / (many - before);
    }
    if (trial.sequence.frames < trial.count) {
      return "";  // interrupted
    }
    const double seconds = opening_s + trial.seconds + (frames - trial.count) * of_frame_s;
    report.set_results({{"forecast",
                         {{"frames_per_second", 1 / of_frame_s},
                          {"seconds", seconds},
                          {"frames_timed", trial.count}}},
                        {"processor_seconds_per_frame", processor_values(trial.sequence)}});
    return fmt::format(
        "run: about {:.3g} frames/s and {:%T} in all, if the others are like the first {} and "
        "the processors are as free as now\n",
        1 / of_frame_s,
        std::chrono::round<std::chrono::seconds>(std::chrono::duration<double>(seconds)),
        trial.count);
  } catch (const Error&) {
    return "";  // the run itself tells of bad frames
  }
}

}  // namespace vantage::apps
