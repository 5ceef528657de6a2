#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "engine/sequence/frame_feed.h"
#include "engine/sequence/sequence_runner.h"
#include "engine/sequence/steps/frame_worker.h"
#include "scheduler/frame_pipeline.h"

namespace vantage {

/// The pipeline of a run, wherever its results go: reads pairs, takes frames through their steps
/// and hands them over in order.
///
/// Thread rule: flow() by one thread at a time. It calls may_read() in the order of the frames, and
/// so write(), skip() and give_up(), one at a time; take() concurrently for different frames.
class FrameFlow {
 public:
  FrameFlow(const FrameFlow&) = delete;
  FrameFlow& operator=(const FrameFlow&) = delete;
  virtual ~FrameFlow() = default;

 protected:
  /// What options and run refer to, and the others, must outlive it. `writes_files`: files of
  /// frames are made.
  FrameFlow(const SequenceOptions& options, SequenceLayout layout, const SequenceRun& run,
            std::vector<FrameRun> work, bool writes_files, Execution& execution);

  /// Returns when the frames of the work are handed over, or further ones may not be read.
  scheduler::FrameOutcome flow(const std::atomic<bool>* stop);

  /// Whether a further frame is read now.
  virtual bool may_read() { return true; }
  /// A frame has begun.
  virtual void begin(FrameSlot& slot) { (void)slot; }
  virtual void take(StepPhase phase, FrameSlot& slot) { worker_.run(phase, slot); }
  /// A frame that has its results; it may keep the slot.
  virtual void write(std::unique_ptr<FrameSlot>& slot) = 0;
  /// A frame that failed, in a run that keeps going. `name`: of its pair.
  virtual void skip(FrameSlot& slot, const std::string& name, const std::string& problem) = 0;
  /// Ends the run, which does not keep going; frames before this one are finished.
  [[noreturn]] virtual void give_up(const FrameSlot& slot, const std::string& name,
                                    const std::string& problem);

  /// Whether all frames of the work have been read. Thread rule: not while frames are in flight.
  [[nodiscard]] bool is_at_end() const { return feed_.is_at_end(); }
  /// Thread rule: one thread at a time.
  void tell_progress(int frames, double cells);
  /// So many frames have reached who takes them: for latencies. Thread rule: any thread.
  void tell_delivered(int frames) { latency_.delivered(frames); }
  /// What is known at the end: frames in flight, time, memory, latency.
  void add_totals(SequenceReport& report) const;

  [[nodiscard]] const SequenceRun& run() const { return run_; }
  [[nodiscard]] const SequenceLayout& layout() const { return layout_; }
  [[nodiscard]] const FrameCameras& cameras() const { return cameras_; }
  [[nodiscard]] StepAccounts& accounts() { return worker_.accounts(); }

 private:
  bool read(std::unique_ptr<FrameSlot>& slot);
  void hand_over(std::unique_ptr<FrameSlot>& slot);
  void handle(FrameSlot& slot, const std::exception_ptr& error);

  const SequenceRun run_;
  const SequenceLayout layout_;
  const FrameCameras cameras_;
  Execution& execution_;
  FrameWorker worker_;
  FrameFeed feed_;      ///< used only by the reading step while frames are in flight
  int next_pair_ = -1;  ///< as feed_; the source may be anywhere at first
  std::vector<std::unique_ptr<FrameSlot>> slots_;
  SequenceProgress progress_;
  LatencyMeter latency_;
};

}  // namespace vantage
