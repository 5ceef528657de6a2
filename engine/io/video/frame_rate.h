#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Frames per second as an exact fraction in lowest terms: 30000/1001 is not 29.97.
struct FrameRate {
  std::int64_t numerator = 25;   ///< 1..1000000
  std::int64_t denominator = 1;  ///< 1..1000000; the rate is at most 1000

  [[nodiscard]] double per_second() const {
    return static_cast<double>(numerator) / static_cast<double>(denominator);
  }
  friend bool operator==(const FrameRate&, const FrameRate&) = default;
};

/// When the first frame of a film is shown.
struct FilmStart {
  double seconds = 0;
  /// The container counts from a moment of its own (MPEG streams), not from 0.
  bool has_clock = false;
};

/// Parses "25", "29.97" or "30000/1001"; empty for any other form or out of range. Decimals within
/// 5 millionths of N·1000/1001 (integer N) are read as that: 29.97 is 30000/1001.
std::optional<FrameRate> parse_frame_rate(std::string_view text);
/// rate / factor (factor ≥ 1); terms beyond the limits are rounded.
FrameRate slowed_down(FrameRate rate, int factor);
/// Frames that are missing between one shown at `before_s` and the next one, shown at `after_s`
/// (seconds); 0 where times do not tell.
int frames_between(double before_s, double after_s, FrameRate rate);
/// "25" or "30000/1001".
std::string to_string(FrameRate rate);

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
  /// Those of some frames, ascending, at least one; the last is as long as before.
  [[nodiscard]] FrameTimes of(const std::vector<int>& frames) const;

  friend bool operator==(const FrameTimes&, const FrameTimes&) = default;
};

/// Whether ascending times, in units of `unit_seconds`, are more than a quarter of a frame away
/// from those of a constant rate. Files with units of milliseconds round such times.
bool are_uneven(const std::vector<std::int64_t>& times, double unit_seconds, FrameRate rate);

}  // namespace vantage
