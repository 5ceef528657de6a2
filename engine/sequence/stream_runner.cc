#include "engine/sequence/stream_runner.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "engine/error.h"
#include "engine/sequence/frame_feed.h"
#include "engine/sequence/journal/pending_files.h"
#include "engine/sequence/steps/frame_memory.h"
#include "engine/sequence/steps/frame_worker.h"
#include "engine/sequence/steps/step_accounts.h"
#include "scheduler/frame_pipeline.h"

namespace vantage {
namespace {

class StreamRun {
 public:
  StreamRun(const SequenceOptions& options, const SequenceRun& run, const SequenceLayout& layout,
            StreamedVideoWriter& writer, Execution& execution)
      : run_(run),
        layout_(layout),
        writer_(writer),
        execution_(execution),
        worker_({options, layout, run.pairs, run.frame_size, run.rectifier, run.pair_cameras,
                 run.cameras, nullptr, nullptr, nullptr, execution, accounts_}),
        slots_(static_cast<std::size_t>(run.in_flight)),
        feed_({run_of(run.selection, dependence_of(options, layout), run.selection.own())}) {
    report_.in_flight = run.in_flight;
  }

  SequenceReport work() {
    const auto slot_of = [this](int slot) -> FrameSlot& {
      return slots_[static_cast<std::size_t>(slot)];
    };
    scheduler::FrameSteps steps;
    steps.read = [&](int slot) { return read(slot_of(slot)); };
    steps.prepare = [&](int slot) { worker_.prepare(slot_of(slot)); };
    steps.compute = [&](int slot) { worker_.compute(slot_of(slot)); };
    steps.encode = [&](int slot) { worker_.finish(slot_of(slot)); };
    steps.write = [&](int slot) { write(slot_of(slot)); };
    steps.compute_in_order = worker_.computes_in_order();
    const auto skip = [&](int slot, const std::exception_ptr& error) {
      return skip_frame(slot_of(slot), error);
    };
    const scheduler::FrameOutcome outcome =
        scheduler::run_frames(execution_.executor(), run_.in_flight, steps, skip, run_.stop);
    // Where the source is a stream, it has ended early.
    report_.interrupted = outcome.interrupted ||
                          (run_.pairs.is_stream() && run_.stop != nullptr && run_.stop->load());
    report_.compute_seconds = worker_.compute_seconds();
    for (const FrameSlot& slot : slots_) {
      report_.memory.add("frames in flight", held_bytes(slot));
    }
    worker_.add_memory_use(report_.memory);
    return std::move(report_);
  }

 private:
  bool read(FrameSlot& slot) {
    slot.times.clear();
    slot.is_absent = false;
    slot.stored = nullptr;
    if (!feed_.next(slot.frame, slot.is_lead_in)) {
      return false;
    }
    if (slot.frame != next_pair_) {
      run_.pairs.skip_to(slot.frame);
    }
    next_pair_ = slot.frame + 1;
    return run_.pairs.fetch(slot.pair);
  }

  void write(FrameSlot& slot) {
    if (slot.is_lead_in) {
      return;
    }
    worker_.copy_picture(slot, layout_.streams().front(), last_);
    put_last();
    has_last_ = true;
    ++report_.frames;
    report_.width_px = slot.left->width();
    report_.height_px = slot.left->height();
    report_.cells += slot.match.cells;
    report_.plan = slot.match.plan;
    for (const std::string& remark : slot.pair.remarks) {
      report_.remarks.push_back({slot.frame, remark});
    }
    tell_progress(slot.match.cells);
  }

  bool skip_frame(FrameSlot& slot, const std::exception_ptr& error) {
    try {
      std::rethrow_exception(error);
    } catch (const OutputError&) {
      throw;
    } catch (const UsageError&) {
      throw;
    } catch (const Error& bad) {
      const std::string name = run_.pairs.describe(slot.frame);
      if (!run_.keep_going) {
        const std::string text = bad.what();
        // Problems of a stream name their frame.
        throw Error(text.starts_with(name)
                        ? text
                        : fmt::format("frame {} ({}): {}", slot.frame, name, text));
      }
      if (slot.is_lead_in) {
        return true;
      }
      report_.skipped.push_back({slot.frame, fmt::format("{}: {}", name, bad.what())});
    }
    if (has_last_) {
      put_last();
    }
    tell_progress(0);
    return true;
  }

  void put_last() {
    try {
      writer_.write(last_);
    } catch (const Error& error) {
      throw OutputError(error.what());
    }
  }

  void tell_progress(double cells) {
    ++progress_.frames_done;
    progress_.frames_total = feed_.frames_total() < kUnknownFrames ? feed_.frames_total() : 0;
    progress_.cells += cells;
    if (run_.on_progress) {
      run_.on_progress(progress_);
    }
  }

  const SequenceRun& run_;
  const SequenceLayout& layout_;
  StreamedVideoWriter& writer_;
  Execution& execution_;
  StepAccounts accounts_;
  FrameWorker worker_;
  std::vector<FrameSlot> slots_;
  FrameFeed feed_;
  int next_pair_ = -1;  ///< the source may be anywhere at first
  Photograph last_;
  bool has_last_ = false;
  SequenceReport report_;
  SequenceProgress progress_;
};

}  // namespace

SequenceReport run_stream(const SequenceOptions& options, const SequenceRun& run,
                          StreamedVideoWriter& writer, Execution& execution) {
  const SequenceLayout layout("-", options);
  return StreamRun(options, run, layout, writer, execution).work();
}

}  // namespace vantage
