#include "scheduler/executor.h"

#include "scheduler/openmp_executor.h"
#include "scheduler/serial_executor.h"
#include "scheduler/tbb_executor.h"

namespace vantage::scheduler {

std::unique_ptr<Executor> make_executor(ExecutorKind kind, int threads) {
  switch (kind) {
    case ExecutorKind::kTbb:
      return make_tbb_executor(threads);
    case ExecutorKind::kOpenMp:
      return make_openmp_executor(threads);
    case ExecutorKind::kSerial:
      break;
  }
  return std::make_unique<SerialExecutor>();
}

}  // namespace vantage::scheduler
