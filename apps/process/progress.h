#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <string>

namespace vantage::apps {

enum class ProgressStyle {
  kAuto,   ///< a bar on a terminal, else lines
  kBar,    ///< redrawn in place
  kPlain,  ///< a line every few seconds, for logs
  kNone
};

/// Progress of a long job on stderr, with rate and time left. Both are computed from the last
/// minute, so that a slow start or an earlier fast part does not distort them; no time is shown
/// until there are enough samples. Thread rule: one thread at a time.
class Progress {
 public:
  /// `unit` is what is counted ("frames").
  Progress(std::string command, std::string unit, ProgressStyle style);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Ends the line of the bar.
  ~Progress();

  /// `done` of `total` (if known), having computed `cells` so far.
  void update(int done, std::optional<int> total, double cells);

 private:
  using Clock = std::chrono::steady_clock;
  struct Sample {
    Clock::time_point time;
    int done = 0;
    double cells = 0;
  };
  [[nodiscard]] std::string describe(const Sample& now, std::optional<int> total) const;

  std::string command_;
  std::string unit_;
  ProgressStyle style_;  ///< not kAuto
  bool line_open_ = false;
  std::deque<Sample> samples_;  ///< of the last minute, the oldest first
  Clock::time_point next_print_;
};

}  // namespace vantage::apps
