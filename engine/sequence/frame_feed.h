#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/sequence/work_plan.h"

namespace vantage {

/// Yields the frames to process, in order. Thread rule: one thread at a time.
class FrameFeed {
 public:
  explicit FrameFeed(std::vector<FrameRun> runs) : runs_(std::move(runs)) {
    for (const FrameRun& run : runs_) {
      frames_total_ += run.frames.count();
    }
    start_run();
  }

  /// Number of frames to deliver.
  [[nodiscard]] int frames_total() const { return frames_total_; }

  [[nodiscard]] bool is_at_end() const { return run_ == runs_.size(); }
  /// There are no more frames.
  void end() { run_ = runs_.size(); }

  /// Returns the next frame; false at the end.
  bool next(int& frame, bool& is_lead_in) {
    if (is_at_end()) {
      return false;
    }
    frame = next_frame_++;
    is_lead_in = frame < runs_[run_].frames.first;
    if (next_frame_ == runs_[run_].frames.end) {
      ++run_;
      start_run();
    }
    return true;
  }

 private:
  void start_run() {
    if (run_ < runs_.size()) {
      next_frame_ = runs_[run_].frames.first - runs_[run_].lead_in;
    }
  }

  std::vector<FrameRun> runs_;
  std::size_t run_ = 0;
  int next_frame_ = 0;
  int frames_total_ = 0;
};

}  // namespace vantage
