#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/execution.h"
#include "engine/io/images/preview.h"
#include "engine/reprojection/map_camera.h"
#include "engine/sequence/sequence_runner.h"
#include "engine/sequence/steps/frame_slot.h"

namespace vantage {

/// A frame of a sequence with its maps and pictures.
struct ComputedFrame {
  std::unique_ptr<FrameSlot> slot;  ///< its files are not made
  DisparityRange searched;          ///< its range of disparities
  PreviewRange preview;             ///< the colours of its previews
  bool has_both_maps = false;
  std::optional<MapCamera> camera = std::nullopt;  ///< of its map, if the run has one
};

/// The frames of a sequence, one after the other, as SequenceRunner makes them, for a caller in the
/// same process. A thread of its own computes them ahead: the frames that are being computed and
/// those that wait for the caller are together at most `run.in_flight`, in the threads of the
/// execution. No thread of that waits for the caller.
///
/// Thread rule: one call at a time, but for stop(). Frames are identical for any Execution and
/// in-flight count.
class FrameIterator {
 public:
  /// `frames`: numbers of pairs, increasing; frames that they depend on are computed, too. Of a
  /// stream all are taken, whatever it says, and waiting for pairs holds no thread either. Options
  /// must be valid. What options, run and execution refer to must outlive the iterator; `run.stop`
  /// and `run.on_progress` are not used.
  FrameIterator(const SequenceOptions& options, const SequenceRun& run,
                const std::vector<int>& frames, Execution& execution);
  FrameIterator(const FrameIterator&) = delete;
  FrameIterator& operator=(const FrameIterator&) = delete;
  ~FrameIterator();

  /// The next frame, empty at the end. Throws Error that names the frame at the first bad one,
  /// after all frames before it, unless `run.keep_going`; then there are no more frames. An
  /// InterruptibleScope ends the wait.
  std::optional<ComputedFrame> next();
  /// Ends what is in work and drops what is ready; there are no more frames. next() of another
  /// thread returns. Thread rule: any thread, beside next().
  void stop();
  /// Frames that were left out so far, with `run.keep_going`.
  [[nodiscard]] std::vector<FrameRemark> skipped() const;

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vantage
