#pragma once

#include <functional>
#include <vector>

#include "engine/tuning/tuned_settings.h"

namespace vantage {

/// Seconds since any fixed moment; never runs backwards.
using TuningClock = std::function<double()>;

/// What is to become faster, and which ways of doing it are worth a try.
class TuningSubject {
 public:
  TuningSubject() = default;
  TuningSubject(const TuningSubject&) = delete;
  TuningSubject& operator=(const TuningSubject&) = delete;
  virtual ~TuningSubject() = default;

  /// Settings that differ from `incumbent` in `coordinate` (and may leave to the cost model what
  /// depends on it), the most promising first. `finely`: only near the incumbent, else over all of
  /// its range. Empty where the coordinate is not to be searched.
  virtual std::vector<TunedSettings> candidates(const TuningCoordinate& coordinate,
                                                const TunedSettings& incumbent, bool finely) = 0;

  /// How long measure() is going to take, in seconds; rather too much than too little.
  virtual double expected_seconds(const TunedSettings& settings) = 0;

  /// Does the work once and tells how long a frame took, in seconds.
  virtual double measure(const TunedSettings& settings) = 0;
};

}  // namespace vantage
