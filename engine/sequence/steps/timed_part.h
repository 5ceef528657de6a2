#pragma once

#include <chrono>
#include <string_view>

#include "engine/seconds_since.h"
#include "engine/sequence/steps/frame_slot.h"
#include "scheduler/trace.h"

namespace vantage {

/// Adds the time until its destruction to the times of a slot and to traces. `name` must be a
/// literal.
class TimedPart {
 public:
  TimedPart(FrameSlot& slot, std::string_view name) : slot_(slot), name_(name), span_(name) {}
  TimedPart(const TimedPart&) = delete;
  TimedPart& operator=(const TimedPart&) = delete;
  ~TimedPart() { slot_.times.push_back({name_, seconds_since(start_)}); }

 private:
  FrameSlot& slot_;
  std::string_view name_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  scheduler::Span span_;
};

}  // namespace vantage
