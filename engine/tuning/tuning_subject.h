#pragma once

#include <functional>
#include <vector>

#include "engine/tuning/tuned_settings.h"

namespace vantage {

/// Seconds since any fixed time; monotonic.
using TuningClock = std::function<double()>;

/// The work to speed up, and candidate settings for it.
class TuningSubject {
 public:
  TuningSubject() = default;
  TuningSubject(const TuningSubject&) = delete;
  TuningSubject& operator=(const TuningSubject&) = delete;
  virtual ~TuningSubject() = default;

  /// Settings that differ from `incumbent` in `coordinate` (and may leave dependent ones to the
  /// cost model), the most promising first. `finely`: only near the incumbent, else over the whole
  /// range. Empty if the coordinate is not searched.
  virtual std::vector<TunedSettings> candidates(const TuningCoordinate& coordinate,
                                                const TunedSettings& incumbent, bool finely) = 0;

  /// Expected duration of measure(), in seconds; an upper estimate.
  virtual double expected_seconds(const TunedSettings& settings) = 0;

  /// Does the work once and returns the seconds per frame.
  virtual double measure(const TunedSettings& settings) = 0;
};

}  // namespace vantage
