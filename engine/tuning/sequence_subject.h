#pragma once

#include <cstdint>
#include <vector>

#include "engine/tuning/match_subject.h"

namespace vantage {

/// Several frames that go through a pipeline as in a run: decoded, matched (one map, without
/// refinement) and encoded, from memory to memory. Searches the frames in flight, too.
class SequenceSubject final : public MatchSubject {
 public:
  /// As MatchSubject.
  SequenceSubject(const MatchSubjectOptions& options, const TuningPair& pair);

  /// Of one measurement.
  [[nodiscard]] int frames() const { return frames_; }

 private:
  /// What a frame under way holds.
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
