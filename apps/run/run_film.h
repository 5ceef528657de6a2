#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "apps/run/run_session.h"
#include "apps/run/run_settings.h"
#include "engine/execution.h"
#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/synthesis/pair_with_maps.h"

namespace vantage::apps {

/// The frames of a run that has been made: its input, read again, and the maps of its folder.
/// Thread rule: one thread at a time.
class RunFilm {
 public:
  /// Opens the run in `folder`. Throws Error if there is none, its input was a stream, is gone or
  /// has changed, or if it has not both maps of rectified pairs of one size.
  explicit RunFilm(const std::string& folder);

  /// The frames of all parts of the run.
  [[nodiscard]] FrameRange frames() const { return session_.selection.all(); }
  [[nodiscard]] FrameRate rate() const { return job_.sequence.frame_rate; }
  [[nodiscard]] const PairSource& pairs() const { return *session_.pairs; }
  /// Why a frame cannot be read: it was left out, or is not there. Empty: it can.
  [[nodiscard]] std::string problem(int frame) const;
  /// The pair as the run matched it, its maps, and its cameras if the run has a calibration.
  /// Throws Error.
  PairWithMaps read(int frame, Execution& execution);

 private:
  [[nodiscard]] DisparityMap read_map(int frame, SequenceOutput output) const;

  RunJob job_;
  RunSession session_;
  std::unique_ptr<const SequenceLayout> layout_;
  std::unique_ptr<const DeliveredFrames> delivered_;
};

}  // namespace vantage::apps
