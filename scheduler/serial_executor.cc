#include "scheduler/serial_executor.h"

namespace vantage::scheduler {

void SerialExecutor::parallel_for(int task_count, const std::function<void(int)>& body) {
  for (int task = 0; task < task_count; ++task) {
    body(task);
  }
}

void SerialExecutor::run_frame_steps(int in_flight, const FrameSteps& steps) {
  for (int slot = 0; steps.read(slot); slot = (slot + 1) % in_flight) {
    steps.prepare(slot);
    steps.compute(slot);
    steps.encode(slot);
    steps.write(slot);
  }
}

}  // namespace vantage::scheduler
