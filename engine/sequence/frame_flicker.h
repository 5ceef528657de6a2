#pragma once

#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/past/flicker.h"
#include "engine/sequence/steps/frame_slot.h"

namespace vantage {

/// Compares each frame with the one before it in its chunk. Thread rule: one call at a time.
class FrameFlicker {
 public:
  /// Both must outlive it.
  FrameFlicker(const SequenceOptions& options, Execution& execution)
      : options_(options), execution_(execution), meter_(options.temporal.threshold) {}

  /// All 0 unless options.measure_flicker, and for a frame without its predecessor.
  FlickerSums add(const FrameSlot& slot);

 private:
  const SequenceOptions& options_;
  Execution& execution_;
  FlickerMeter meter_;
  int next_frame_ = -1;
};

}  // namespace vantage
