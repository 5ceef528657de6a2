#include "engine/sequence/latency_meter.h"

#include <algorithm>

#include "engine/order_statistics.h"
#include "engine/seconds_since.h"

namespace vantage {

void LatencyMeter::leaves(std::optional<Time> arrival) {
  const std::scoped_lock lock(mutex_);
  on_their_way_.push_back(arrival);
}

void LatencyMeter::delivered(int frames) {
  const std::scoped_lock lock(mutex_);
  for (; frames > 0 && !on_their_way_.empty(); --frames) {
    if (const std::optional<Time> arrival = on_their_way_.front()) {
      latencies_ms_.push_back(static_cast<float>(1e3 * seconds_since(*arrival)));
    }
    on_their_way_.pop_front();
  }
}

LiveReport LatencyMeter::report() const {
  const std::scoped_lock lock(mutex_);
  LiveReport report;
  std::vector<float> sorted = latencies_ms_;
  if (!sorted.empty()) {
    report.frames = static_cast<int>(sorted.size());
    report.median_ms = static_cast<double>(percentile(sorted, 0.5));
    report.percentile_95_ms = static_cast<double>(percentile(sorted, 0.95));
    report.max_ms = static_cast<double>(std::ranges::max(sorted));
  }
  return report;
}

}  // namespace vantage
