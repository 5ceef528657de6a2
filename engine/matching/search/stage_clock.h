#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "engine/matching/search/match_report.h"
#include "scheduler/trace.h"

namespace vantage {

/// Times consecutive stages for a report and emits them as trace spans.
class StageClock {
 public:
  explicit StageClock(MatchReport& report) : report_(report) {}
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;
  ~StageClock() { end(); }
  /// Ends the previous stage. `name` has static storage.
  void start(std::string_view name) {
    end();
    name_ = name;
    start_ = Clock::now();
    span_.emplace(name);
  }

 private:
  using Clock = std::chrono::steady_clock;
  void end() {
    if (span_) {
      span_.reset();
      report_.stages.push_back(
          {name_, std::chrono::duration<double>(Clock::now() - start_).count()});
    }
  }

  MatchReport& report_;
  std::string_view name_;
  Clock::time_point start_;
  std::optional<scheduler::Span> span_;
};

}  // namespace vantage
