#pragma once

#include <optional>
#include <string>

#include "engine/sequence/pairs/pair_source.h"
#include "engine/view_geometry/trajectory_file.h"

namespace vantage {

/// Poses of the left camera of a run. A pose belongs to the pair of its number, counted from 0. Of
/// a trajectory with times and image files whose names are times, in seconds
/// (1305031102.175304.png) or nanoseconds (1403636579763555584.png), it belongs to the pair nearest
/// in time. Thread rule: may be used concurrently.
class FramePoses {
 public:
  /// `file` is its name in messages.
  FramePoses(Trajectory trajectory, std::string file);

  /// Throws Error if there is none for a pair; of times, if none is within 20 ms.
  [[nodiscard]] const CameraPose& of(const FramePair& pair) const;

  /// The number of poses, if they belong to pairs by number; empty: by time. `pair`: any pair of
  /// the run.
  [[nodiscard]] std::optional<int> numbered(const FramePair& pair) const;
  /// Their numbers are those of the left camera's frames, of which some are in no pair.
  void count_frames() { counts_frames_ = true; }

 private:
  Trajectory trajectory_;
  std::string file_;
  bool counts_frames_ = false;
};

}  // namespace vantage
