#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/io/frame_source.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/sequence_options.h"

namespace vantage {

/// Where a run stands after a frame has been written.
struct SequenceProgress {
  int frames_done = 0;
  std::optional<int> frames_total;  ///< when both sources know their length
  double cells = 0;                 ///< matching cells computed for the frames done
};

/// Seconds of one stage, summed over frames (frames overlap, so sums may exceed wall time).
struct SequenceStage {
  std::string name;
  double seconds = 0;
};

struct SequenceReport {
  int frames = 0;
  bool interrupted = false;  ///< `stop` was raised before the sources ended
  int in_flight = 0;
  int width_px = 0;  ///< of the last frame
  int height_px = 0;
  double cells = 0;
  /// Time during which at least one frame was being matched or rendered: no reading or writing.
  double compute_seconds = 0;
  std::vector<SequenceStage> stages;  ///< in order of first appearance, with "read" and "write"
  scheduler::ChainPlan plan;          ///< of the last frame
};

/// Turns two sequences of frames into disparity maps and new views on disk, in order. The strips of
/// several frames share the executor's threads; memory is bounded by the frames in flight, whose
/// buffers are reused.
///
/// Thread rule: one run() at a time. Files are identical for any ExecutionOptions and in-flight
/// count. Each file appears whole or not at all.
class SequenceRunner {
 public:
  /// Throws UsageError for invalid options. `execution` must outlive the runner.
  SequenceRunner(const SequenceOptions& options, Execution& execution);

  /// Makes `folder` and the folders below it, then works until a source ends. `on_frame` is called
  /// after each written frame, in order, never concurrently. Raising `stop` reads no further frame
  /// and finishes those under way.
  ///
  /// Throws Error at the first bad frame, naming its number and file, after all earlier frames are
  /// written and with none after it; likewise when one source ends before the other, naming both
  /// lengths.
  SequenceReport run(FrameSource& left, FrameSource& right, const std::filesystem::path& folder,
                     const std::function<void(const SequenceProgress&)>& on_frame = {},
                     const std::atomic<bool>* stop = nullptr) const;

 private:
  SequenceOptions options_;
  Execution& execution_;
};

}  // namespace vantage
