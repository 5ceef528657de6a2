#pragma once

#include <cstdint>
#include <vector>

#include "engine/tuning/match_subject.h"

namespace vantage {

/// Several frames in a pipeline as in a run: decoded, matched (one map, without refinement) and
/// encoded, from memory to memory. Also searches the number of frames in flight.
class SequenceSubject final : public MatchSubject {
 public:
  /// As MatchSubject.
  SequenceSubject(const MatchSubjectOptions& options, const TuningPair& pair);

  /// Frames per measurement.
  [[nodiscard]] int frames() const { return frames_; }

 private:
  /// Buffers of a frame in flight.
  struct Slot {
    Photograph left;
    Photograph right;
    DisparityMaps maps;
    std::vector<std::uint8_t> file;
  };

  int work(Runner& runner) override;
  [[nodiscard]] std::vector<int> more_values(const TuningCoordinate& coordinate,
                                             const TunedSettings& incumbent,
                                             bool finely) const override;
  [[nodiscard]] int in_flight_of(const TunedSettings& settings) const;

  int frames_ = 0;
  std::vector<Slot> slots_;  // kept from measurement to measurement
  std::vector<std::uint8_t> left_file_;
  std::vector<std::uint8_t> right_file_;
};

}  // namespace vantage
