#include "engine/sequence/sequence_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <exception>
#include <iterator>
#include <map>
#include <utility>

#include "engine/error.h"
#include "engine/seconds_since.h"
#include "engine/sequence/frame_feed.h"
#include "engine/sequence/frame_flicker.h"
#include "engine/sequence/journal/commit_queue.h"
#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/journal/leftovers.h"
#include "engine/sequence/run_totals.h"
#include "engine/sequence/segment_writer.h"
#include "engine/sequence/steps/frame_memory.h"
#include "engine/sequence/steps/frame_worker.h"
#include "scheduler/frame_pipeline.h"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

/// Of this process, all threads.
double processor_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Whether a frame was made without one that it depends on, because that one was skipped.
bool lacks_past(const std::vector<int>& skipped, int frame, int chunk_begin,
                FrameDependence::Past past) {
  using Past = FrameDependence::Past;
  const int first = past == Past::kNone  ? frame
                    : past == Past::kOne ? std::max(chunk_begin, frame - 1)
                                         : chunk_begin;
  const auto next = std::ranges::lower_bound(skipped, first);
  return next != skipped.end() && *next < frame;
}

/// A frame of a stream that ends the run; the frames before it are finished.
class BadStreamFrame : public Error {
 public:
  using Error::Error;
};

/// One run: the ordered steps of a frame, and the totals.
class Run {
 public:
  Run(const SequenceOptions& options, const SequenceRun& run, const SequenceLayout& layout,
      RunJournal& journal, std::vector<FrameRun> work, std::map<int, const FrameRecord*> stored,
      Execution& execution)
      : options_(options),
        run_(run),
        layout_(layout),
        execution_(execution),
        worker_({options, layout, run.pairs, run.frame_size, run.rectifier, run.pair_cameras,
                 run.cameras, run.map_camera, run.poses, run.shots, execution, accounts_}),
        feed_(std::move(work)),
        stored_(std::move(stored)),
        segments_(options, layout, worker_, run.frame_size.value_or(ImageExtent()), execution),
        flicker_(options, execution),
        slots_(static_cast<std::size_t>(run.in_flight)),
        queue_(
            journal, [this](int frames, double cells) { tell_progress(frames, cells); },
            accounts_.of(RunStep::kDeliver)) {
    report_.in_flight = run.in_flight;
  }

  SequenceReport work() {
    const Clock::time_point start = Clock::now();
    const double processor_at_start = processor_seconds();
    const auto slot_of = [this](int slot) -> FrameSlot& {
      return slots_[static_cast<std::size_t>(slot)];
    };
    scheduler::FrameSteps steps;
    steps.read = [&](int slot) { return read(slot_of(slot)); };
    steps.prepare = [&](int slot) { worker_.prepare(slot_of(slot)); };
    steps.compute = [&](int slot) { worker_.compute(slot_of(slot)); };
    steps.encode = [&](int slot) {
      worker_.finish(slot_of(slot));
      worker_.encode(slot_of(slot));
    };
    steps.write = [&](int slot) { write(slot_of(slot)); };
    steps.compute_in_order = worker_.computes_in_order();
    const auto skip = [&](int slot, const std::exception_ptr& error) {
      return skip_frame(slot_of(slot), error);
    };
    try {
      const scheduler::FrameOutcome outcome =
          scheduler::run_frames(execution_.executor(), run_.in_flight, steps, skip, run_.stop);
      report_.interrupted = outcome.interrupted;
    } catch (const BadStreamFrame& bad) {
      report_.stream_problem = bad.what();
    }
    if (run_.pairs.is_stream()) {
      finish_stream();
      // Ctrl-C stops the program that writes the stream as well: the stream ends before the stop is
      // noticed.
      report_.interrupted = run_.stop != nullptr && run_.stop->load();
    }
    queue_.finish();
    // Not counted: frames that exist only in the abandoned videos of an unfinished chunk.
    report_.frames -= frames_of_segment_;
    report_.videos_from = segment_begin_;
    report_.compute_seconds = worker_.compute_seconds();
    for (const FrameSlot& slot : slots_) {
      report_.memory.add("frames in flight", held_bytes(slot));
    }
    worker_.add_memory_use(report_.memory);
    add_processor_time(report_, accounts_, processor_seconds() - processor_at_start,
                       seconds_since(start), execution_.executor().thread_count());
    return std::move(report_);
  }

 private:
  bool read(FrameSlot& slot) {
    const Clock::time_point start = Clock::now();
    const scheduler::ProcessorCharge charge(accounts_.of(RunStep::kRead));
    slot.times.clear();
    if (!feed_.next(slot.frame, slot.is_lead_in)) {
      return false;
    }
    if (slot.frame != next_pair_) {
      run_.pairs.skip_to(slot.frame);
    }
    next_pair_ = slot.frame + 1;
    const auto known = stored_.find(slot.frame);
    slot.stored = known == stored_.end() ? nullptr : known->second;
    // Some containers promise a few frames more than they have; a truncated file throws.
    slot.is_absent = !run_.pairs.fetch(slot.pair);
    if (slot.is_absent && run_.pairs.is_stream()) {
      return false;
    }
    slot.times.push_back({"read", seconds_since(start)});
    return true;
  }

  void write(FrameSlot& slot) {
    if (slot.is_absent) {
      note_absence(slot);
      return;
    }
    const Clock::time_point start = Clock::now();
    const scheduler::ProcessorCharge charge(accounts_.of(RunStep::kWrite));
    FrameRecord record{
        .frame = slot.frame, .name = slot.pair.details.name, .files = std::move(slot.file_records)};
    record.comfort = slot.comfort;
    record.disparities = slot.disparities;
    record.flicker = flicker_.add(slot);
    if (slot.is_lead_in) {
      return;
    }
    if (run_.pairs.is_stream()) {
      cuts_.add(slot.thumbnail);
    }
    note_oddities(slot, record);
    if (layout_.has_videos()) {
      segment_of(slot.frame);
      segments_.add(slot);
    }
    slot.times.push_back({"write", seconds_since(start)});
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
    if (layout_.has_videos()) {
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

  bool skip_frame(FrameSlot& slot, const std::exception_ptr& error) {
    slot.files.discard();
    std::string problem;
    try {
      std::rethrow_exception(error);
    } catch (const DeliveryError&) {
      throw;
    } catch (const OutputError& output) {
      throw OutputError(fmt::format("frame {}: {}", slot.frame, output.what()));
    } catch (const UsageError&) {
      throw;
    } catch (const Error& bad_frame) {
      problem = bad_frame.what();
    }
    const std::string name = run_.pairs.describe(slot.frame);
    // Problems of a stream name their frame.
    const std::string named =
        problem.starts_with(name) ? problem : fmt::format("{}: {}", name, problem);
    if (!run_.keep_going) {
      if (run_.pairs.is_stream()) {
        throw BadStreamFrame(named);
      }
      throw Error(fmt::format("frame {} ({}): {}", slot.frame, name, problem));
    }
    if (slot.is_lead_in) {
      return true;  // recorded when it is delivered
    }
    if (run_.pairs.is_stream()) {
      cuts_.add(std::nullopt);
    }
    report_.skipped.push_back({slot.frame, named});
    if (layout_.has_videos()) {
      segment_of(slot.frame);
      segments_.add_skipped();
    }
    deliver(slot.frame, {},
            FrameRecord{.frame = slot.frame, .skipped = true, .problem = std::move(problem)}, 0);
    return true;
  }

  /// Starts the segment of the frame if it is the first one there.
  void segment_of(int frame) {
    const FrameRange chunk = run_.selection.chunk_of(frame);
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
    if (record && (!layout_.has_videos() || !record->files.empty())) {
      delivery.records.emplace_back(*std::move(record));
    } else if (record) {
      frames_of_segment_ += record->skipped || record->absent ? 0 : 1;
      segment_records_.emplace_back(*std::move(record));
    }
    last_delivered_ = frame;
    const FrameRange chunk = run_.selection.chunk_of(frame);
    if (layout_.has_videos() && frame + 1 == chunk.end) {
      end_segment(chunk, delivery);
    }
    queue_.push(std::move(delivery));
  }

  /// Adds the videos of `frames`, the segment so far, to a delivery.
  void end_segment(FrameRange frames, Delivery& delivery) {
    delivery.videos = segments_.end(frames);
    if (!delivery.videos.empty()) {
      delivery.folder = layout_.folder();
      delivery.segment = SegmentRecord{frames};
      for (std::string& name : layout_.segment_names(frames)) {
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
    const FrameRange frames{run_.selection.own().first, last_delivered_ + 1};
    if (options_.needs_shots() && !frames.empty()) {
      report_.shots = shots_at(cuts_, frames, options_);
    }
  }

  void tell_progress(int frames, double cells) {
    progress_.frames_done += frames;
    progress_.frames_total = feed_.frames_total() < kUnknownFrames ? feed_.frames_total() : 0;
    progress_.cells += cells;
    if (run_.on_progress) {
      run_.on_progress(progress_);
    }
  }

  const SequenceOptions& options_;
  const SequenceRun& run_;
  const SequenceLayout& layout_;
  Execution& execution_;
  StepAccounts accounts_;
  FrameWorker worker_;
  FrameFeed feed_;  // used only by the reading step while frames are in flight
  std::map<int, const FrameRecord*> stored_;
  int next_pair_ = -1;  // as feed_; the source may be anywhere at first
  // The following members, up to the slots, are used only by the writing step.
  SegmentWriter segments_;
  std::vector<JournalRecord> segment_records_;
  int frames_of_segment_ = 0;         // counted in the report although the segment is unfinished
  std::optional<int> segment_begin_;  // start of the unfinished segment
  int last_delivered_ = -1;
  ShotCuts cuts_;  // of a stream
  FrameFlicker flicker_;
  int last_frame_ = -2;
  std::array<std::uint64_t, 2> last_content_ = {};
  SequenceReport report_;
  std::vector<FrameSlot> slots_;
  SequenceProgress progress_;  // used only by the queue's thread
  CommitQueue queue_;          // last: its thread uses all other members
};

}  // namespace

FrameDependence dependence_of(const SequenceOptions& options, const SequenceLayout& layout) {
  using Past = FrameDependence::Past;
  return {.past = options.temporal.uses_past() ? Past::kChunk
                  : options.measure_flicker    ? Past::kOne
                                               : Past::kNone,
          .whole_chunks = layout.has_videos()};
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
  const auto lacks = [&](int frame) {
    return lacks_past(skipped, frame, run.selection.chunk_begin(frame), dependence.past);
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
