#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace vantage::perf {

/// Time of one frame, in seconds: wall clock, and processor time over all the process's threads.
/// The second hardly depends on other load of the machine.
struct FrameTime {
  double wall = 0;
  double processor = 0;
};

class Stopwatch {
 public:
  [[nodiscard]] FrameTime per_frame(int frames) const {
    const std::chrono::duration<double> wall = Clock::now() - wall_start_;
    return {wall.count() / frames, (processor_seconds() - processor_start_) / frames};
  }

 private:
  using Clock = std::chrono::steady_clock;

  static double processor_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }

  Clock::time_point wall_start_ = Clock::now();
  double processor_start_ = processor_seconds();
};

inline double min(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

inline double max(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

inline std::vector<double> of(const std::vector<FrameTime>& rounds, double FrameTime::*time) {
  std::vector<double> values;
  values.reserve(rounds.size());
  for (const FrameTime& round : rounds) {
    values.push_back(round.*time);
  }
  return values;
}

/// Ratios of wall times of one contender to another, round by round.
inline std::vector<double> ratios(const std::vector<FrameTime>& rounds,
                                  const std::vector<FrameTime>& to) {
  std::vector<double> values;
  for (std::size_t round = 0; round < rounds.size(); ++round) {
    values.push_back(rounds[round].wall / to[round].wall);
  }
  return values;
}

}  // namespace vantage::perf
