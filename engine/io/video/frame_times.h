#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/io/video/frame_rate.h"

namespace vantage {

/// When the frames of a video of variable rate are shown: frame i from times[i] to times[i + 1].
struct FrameTimes {
  std::vector<std::int64_t> times;  ///< in units after the first frame of the file; ascending
  std::int64_t unit_numerator = 1;  ///< of a unit in seconds, 1..2³¹ − 1
  std::int64_t unit_denominator = 1000;
  FrameRate rate;  ///< of videos that cannot have these times

  [[nodiscard]] int frame_count() const { return static_cast<int>(times.size()) - 1; }
  /// 0 ≤ frame ≤ frame_count(): its last value is the end of the last frame.
  [[nodiscard]] double seconds(int frame) const;
  /// Those of `count` frames: `first` and every `step`-th after it, which must exist. Each is shown
  /// until the next one.
  [[nodiscard]] FrameTimes some(int first, int count, int step = 1) const;

  friend bool operator==(const FrameTimes&, const FrameTimes&) = default;
};

/// Whether ascending times, in units of `unit_seconds`, are more than a quarter of a frame away
/// from those of a constant rate. Files with units of milliseconds round such times.
bool are_uneven(const std::vector<std::int64_t>& times, double unit_seconds, FrameRate rate);

}  // namespace vantage
