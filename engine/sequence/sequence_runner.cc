#include "engine/sequence/sequence_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <iterator>
#include <map>
#include <utility>

#include "engine/error.h"
#include "engine/seconds_since.h"
#include "engine/sequence/frame_flow.h"
#include "engine/sequence/journal/commit_queue.h"
#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/journal/leftovers.h"
#include "engine/sequence/run_totals.h"
#include "engine/sequence/segment_writer.h"
#include "engine/sequence/steps/timed_part.h"
#include "engine/sequence/steps/video_frames.h"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

/// Of this process, all threads.
double processor_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A frame of a stream that ends the run; the frames before it are finished.
class BadStreamFrame : public Error {
 public:
  using Error::Error;
};

/// One run to a folder: the ordered steps of a frame, and the totals.
class Run final : private FrameFlow {
 public:
  Run(const SequenceOptions& options, const SequenceRun& run, const SequenceLayout& layout,
      RunJournal& journal, std::vector<FrameRun> work, std::map<int, const FrameRecord*> stored,
      Execution& execution)
      : FrameFlow(options, layout, run, std::move(work), true, execution),
        options_(options),
        threads_(execution.executor().thread_count()),
        execution_(execution),
        stored_(std::move(stored)),
        segments_(options, layout, run.frame_size.value_or(ImageExtent()),
                  run.is_live ? 0 : max_frames_waiting(threads_)),
        queue_(
            journal, [this](int frames, double cells) { tell_progress(frames, cells); },
            accounts().of(deliver_step())) {}

  SequenceReport work() {
    const Clock::time_point start = Clock::now();
    const double processor_at_start = processor_seconds();
    try {
      report_.interrupted = flow(run().stop).interrupted;
    } catch (const BadStreamFrame& bad) {
      report_.stream_problem = bad.what();
    }
    if (run().pairs.is_stream()) {
      finish_stream();
      // Ctrl-C stops the program that writes the stream as well: the stream ends before the stop is
      // noticed.
      report_.interrupted = run().stop != nullptr && run().stop->load();
    }
    encode_rest();
    queue_.finish();
    // Not counted: frames that exist only in the abandoned videos of an unfinished chunk.
    report_.frames -= frames_of_segment_;
    report_.videos_from = segment_begin_;
    add_totals(report_);
    add_processor_time(report_, accounts(), processor_seconds() - processor_at_start,
                       seconds_since(start), threads_);
    return std::move(report_);
  }

 private:
  void begin(FrameSlot& slot) override {
    const auto known = stored_.find(slot.frame);
    slot.stored = known == stored_.end() ? nullptr : known->second;
  }

  void take(StepPhase phase, FrameSlot& slot) override {
    FrameFlow::take(phase, slot);
    if (phase == StepPhase::kEncode && layout().has_videos()) {
      encode_others(slot);
    }
  }

  /// Beside its own results a frame encodes what those before it have left to the videos: twice, as
  /// encoders hold frames back and are asked for these at the end of their group.
  void encode_others(FrameSlot& slot) {
    constexpr int kTimes = 2;
    const StepEntry step = write_step();
    const scheduler::ProcessorCharge charge(accounts().of(step));
    const TimedPart part(slot, step.name);
    for (int i = 0; i < kTimes && segments_.encode_some(); ++i) {
    }
  }

  /// What the last frames have left.
  void encode_rest() {
    const scheduler::ProcessorCharge charge(accounts().of(write_step()));
    execution_.executor().parallel_for(threads_, [&](int /*task*/) {
      while (segments_.encode_some()) {
      }
    });
  }

  void write(std::unique_ptr<FrameSlot>& slot) override { write_frame(*slot); }

  void write_frame(FrameSlot& slot) {
    if (slot.is_absent) {
      note_absence(slot);
      return;
    }
    const Clock::time_point start = Clock::now();
    const StepEntry step = write_step();
    const scheduler::ProcessorCharge charge(accounts().of(step));
    FrameRecord record{
        .frame = slot.frame, .name = slot.pair.details.name, .files = std::move(slot.file_records)};
    record.comfort = slot.comfort;
    record.disparities = slot.disparities;
    if (slot.is_lead_in) {
      return;
    }
    if (run().pairs.is_stream()) {
      cuts_.add(slot.thumbnail);
    }
    note_oddities(slot, record);
    if (layout().has_videos()) {
      segment_of(slot.frame);
      segments_.add(slot);
    }
    slot.times.push_back({step.name, seconds_since(start)});
    add_frame(report_, slot);
    if (slot.stored != nullptr) {
      deliver(slot.frame, {}, std::nullopt, slot.match.cells);
    } else {
      deliver(slot.frame, std::move(slot.files), std::move(record), slot.match.cells);
    }
  }

  /// Frames beyond the end of the input are complete, so that nothing waits for them.
  void note_absence(const FrameSlot& slot) {
    if (slot.is_lead_in) {
      return;
    }
    if (layout().has_videos()) {
      segment_of(slot.frame);
    }
    FrameRecord record{.frame = slot.frame, .absent = true};
    record.remarks = {"the input ends before it, although its container lists it"};
    report_.remarks.push_back({slot.frame, record.remarks.front()});
    deliver(slot.frame, {}, std::move(record), 0);
  }

  void note_oddities(FrameSlot& slot, FrameRecord& record) {
    record.remarks = slot.pair.remarks;
    if (slot.frame == last_frame_ + 1) {
      const bool left = slot.content[0] == last_content_[0];
      const bool right = slot.content[1] == last_content_[1];
      if (left || right) {
        record.remarks.push_back(fmt::format("{} the same as in frame {}",
                                             left && right ? "both images are"
                                             : left        ? "the left image is"
                                                           : "the right image is",
                                             last_frame_));
      }
    }
    last_frame_ = slot.frame;
    last_content_ = slot.content;
    if (slot.stored != nullptr) {
      return;  // reported when it was made
    }
    for (const std::string& remark : record.remarks) {
      report_.remarks.push_back({slot.frame, remark});
    }
  }

  /// Problems of a stream name their frame.
  static std::string with_name(const std::string& name, const std::string& problem) {
    return problem.starts_with(name) ? problem : fmt::format("{}: {}", name, problem);
  }

  [[noreturn]] void give_up(const FrameSlot& slot, const std::string& name,
                            const std::string& problem) override {
    if (run().pairs.is_stream()) {
      throw BadStreamFrame(with_name(name, problem));
    }
    FrameFlow::give_up(slot, name, problem);
  }

  void skip(FrameSlot& slot, const std::string& name, const std::string& problem) override {
    if (run().pairs.is_stream()) {
      cuts_.add(std::nullopt);
    }
    report_.skipped.push_back({slot.frame, with_name(name, problem)});
    if (layout().has_videos()) {
      segment_of(slot.frame);
      segments_.add_skipped();
    }
    deliver(slot.frame, {}, FrameRecord{.frame = slot.frame, .skipped = true, .problem = problem},
            0);
  }

  /// Starts the segment of the frame if it is the first one there.
  void segment_of(int frame) {
    const FrameRange chunk = run().selection.chunk_of(frame);
    if (frame == chunk.first) {
      segments_.begin(chunk);
      segment_records_.clear();
      segment_begin_ = chunk.first;
    }
  }

  /// Frames that exist only in videos are recorded when their segment is complete. `record`: empty
  /// for a frame that was delivered before.
  void deliver(int frame, PendingFiles files, std::optional<FrameRecord> record, double cells) {
    Delivery delivery;
    delivery.files = std::move(files);
    delivery.frames = 1;
    delivery.cells = cells;
    delivery.frame = frame;
    if (record && (!layout().has_videos() || !record->files.empty())) {
      delivery.records.emplace_back(*std::move(record));
    } else if (record) {
      frames_of_segment_ += record->skipped || record->absent ? 0 : 1;
      segment_records_.emplace_back(*std::move(record));
    }
    last_delivered_ = frame;
    const FrameRange chunk = run().selection.chunk_of(frame);
    if (layout().has_videos() && frame + 1 == chunk.end) {
      end_segment(chunk, delivery);
    }
    queue_.push(std::move(delivery));
  }

  /// Adds the videos of `frames`, the segment so far, to a delivery.
  void end_segment(FrameRange frames, Delivery& delivery) {
    delivery.videos = segments_.end(frames);
    if (!delivery.videos.empty()) {
      delivery.folder = layout().folder();
      delivery.segment = SegmentRecord{frames};
      for (std::string& name : layout().segment_names(frames)) {
        delivery.segment->files.push_back({.name = std::move(name)});
      }
    }
    std::ranges::move(segment_records_, std::back_inserter(delivery.records));
    segment_records_.clear();
    frames_of_segment_ = 0;
    segment_begin_.reset();
  }

  /// A stream cannot be continued: its last segment is as long as it is.
  void finish_stream() {
    if (segment_begin_) {
      Delivery delivery;
      delivery.frame = last_delivered_;
      end_segment({*segment_begin_, last_delivered_ + 1}, delivery);
      queue_.push(std::move(delivery));
    }
    const FrameRange frames{run().selection.own().first, last_delivered_ + 1};
    if (options_.needs_shots() && !frames.empty()) {
      report_.shots = shots_at(cuts_, frames, options_);
    }
  }

  const SequenceOptions& options_;
  int threads_;
  Execution& execution_;
  std::map<int, const FrameRecord*> stored_;
  // The following members, up to the queue, are used only by the writing step.
  SegmentWriter segments_;
  std::vector<JournalRecord> segment_records_;
  int frames_of_segment_ = 0;         // counted in the report although the segment is unfinished
  std::optional<int> segment_begin_;  // start of the unfinished segment
  int last_delivered_ = -1;
  ShotCuts cuts_;  // of a stream
  int last_frame_ = -2;
  std::array<std::uint64_t, 2> last_content_ = {};
  SequenceReport report_;
  CommitQueue queue_;  // last: its thread tells progress
};

}  // namespace

FrameDependence dependence_of(const SequenceOptions& options, const SequenceLayout& layout) {
  return {.on_past = options.temporal.uses_past(), .whole_chunks = layout.has_videos()};
}

SequenceRunner::SequenceRunner(const SequenceOptions& options, Execution& execution)
    : options_(options), execution_(execution) {
  options_.validate();
}

SequenceReport SequenceRunner::run(const SequenceRun& run, const SequenceLayout& layout,
                                   RunJournal& journal) const {
  layout.make_folders();
  const FrameRange own = run.selection.own();
  remove_leftovers(layout, own);
  if (run.pairs.is_stream()) {
    const FrameRun all = run_of(run.selection, dependence_of(options_, layout), own);
    return Run(options_, run, layout, journal, {all}, {}, execution_).work();
  }
  const DeliveredFrames delivered(layout);
  const FrameDependence dependence = dependence_of(options_, layout);
  const std::vector<int> skipped = delivered.skipped({0, run.selection.frame_count});
  // Whether a frame was made without one that it depends on, because that one was skipped.
  const auto lacks = [&](int frame) {
    const auto next = std::ranges::lower_bound(skipped, run.selection.chunk_begin(frame));
    return dependence.on_past && next != skipped.end() && *next < frame;
  };
  std::vector<FrameRun> work = plan_work(run.selection, dependence, [&](int frame) {
    if (!delivered.is_done(frame) || lacks(frame)) {
      return false;
    }
    const FrameRange chunk = run.selection.chunk_of(frame);
    return !layout.has_videos() || frame != chunk.first || delivered.is_in_one_piece(chunk);
  });
  int before = own.count();
  std::map<int, const FrameRecord*> stored;
  for (const FrameRun& part : work) {
    before -= part.frames.count();
    for (int frame = part.frames.first; dependence.whole_chunks && frame < part.frames.end;
         ++frame) {
      const FrameRecord* record = delivered.files_of(frame);
      if (record != nullptr && !lacks(frame)) {
        stored.emplace(frame, record);
      }
    }
  }
  before += static_cast<int>(stored.size());
  SequenceReport report =
      Run(options_, run, layout, journal, std::move(work), std::move(stored), execution_).work();
  report.frames_before = before;
  return report;
}

}  // namespace vantage
