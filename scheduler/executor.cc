#include "scheduler/executor.h"

#include "scheduler/openmp_executor.h"
#include "scheduler/serial_executor.h"
#include "scheduler/tbb_executor.h"
#include "scheduler/thread_sanitizer.h"
#include "scheduler/traced_executor.h"

namespace vantage::scheduler {
namespace {

std::unique_ptr<Executor> make_plain_executor(ExecutorKind kind, int threads) {
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

}  // namespace

std::unique_ptr<Executor> make_executor(ExecutorKind kind, int threads, ThreadBinding /*binding*/) {
#ifdef VANTAGE_THREAD_SANITIZER
  return with_tracing(with_declared_order(make_plain_executor(kind, threads)));
#else
  return with_tracing(make_plain_executor(kind, threads));
#endif
}

}  // namespace vantage::scheduler
