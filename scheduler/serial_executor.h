#pragma once

#include "scheduler/executor.h"

namespace vantage::scheduler {

/// Runs everything on the calling thread, in order.
class SerialExecutor : public Executor {
 public:
  [[nodiscard]] std::string_view name() const override { return "serial"; }
  [[nodiscard]] int thread_count() const override { return 1; }
  void parallel_for(int task_count, const std::function<void(int)>& body) override;
  void run_frame_steps(int in_flight, const FrameSteps& steps) override;
};

}  // namespace vantage::scheduler
