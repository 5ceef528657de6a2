#pragma once

#include "engine/execution.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage::perf {

/// Computes a method's left map on its own threads.
class MapRunner {
 public:
  MapRunner(const MatchOptions& options, const ExecutionOptions& execution)
      : execution_(execution), matcher_(options, execution_) {}
  void run(const Photograph& left, const Photograph& right) {
    matcher_.match(left, right, {.left = true, .right = false, .unmatched = false}, maps_,
                   &report_);
  }
  [[nodiscard]] const MatchReport& report() const { return report_; }

 private:
  Execution execution_;
  StereoMatcher matcher_;
  DisparityMaps maps_;
  MatchReport report_;
};

}  // namespace vantage::perf
