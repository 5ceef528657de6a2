#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace vantage::apps {

/// Tells people on stderr how far a long job is, with rate and time left: a bar that is redrawn on
/// a terminal, a plain line every few seconds elsewhere. Thread rule: one thread at a time.
class Progress {
 public:
  /// `unit` is what is counted ("frames"). A quiet one prints nothing.
  Progress(std::string command, std::string unit, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Ends the line of the bar.
  ~Progress();

  /// `done` of `total` (if known), having computed `cells` so far.
  void update(int done, std::optional<int> total, double cells);

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] std::string describe(int done, std::optional<int> total, double cells) const;

  std::string command_;
  std::string unit_;
  bool quiet_;
  bool terminal_;
  bool line_open_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_print_;
};

}  // namespace vantage::apps
