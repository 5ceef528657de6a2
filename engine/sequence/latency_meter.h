#pragma once

#include <chrono>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

namespace vantage {

/// Of a live run: what became of the pairs that came.
struct LiveReport {
  int frames = 0;   ///< delivered, of which the latencies are
  int dropped = 0;  ///< left out, because newer ones came before they were taken
  // From the arrival of a pair to the delivery of its results. Zero where nothing was delivered.
  double median_ms = 0;
  double percentile_95_ms = 0;
  double max_ms = 0;
};

/// Times of frames between their arrival and their delivery. Thread rule: any thread.
class LatencyMeter {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The next frame, in order, is handed over. Empty: its time does not count.
  void leaves(std::optional<Time> arrival);
  /// So many of the frames that were handed over have been delivered.
  void delivered(int frames);
  [[nodiscard]] LiveReport report() const;

 private:
  mutable std::mutex mutex_;
  std::deque<std::optional<Time>> on_their_way_;
  std::vector<float> latencies_ms_;
};

}  // namespace vantage
