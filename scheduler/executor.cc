#include "scheduler/executor.h"

#include <stdexcept>

#include "scheduler/openmp_executor.h"
#include "scheduler/serial_executor.h"
#include "scheduler/tbb_executor.h"
#include "scheduler/tbb_node_executor.h"
#include "scheduler/thread_places.h"
#include "scheduler/thread_sanitizer.h"
#include "scheduler/topology.h"
#include "scheduler/traced_executor.h"

namespace vantage::scheduler {
namespace {

std::unique_ptr<Executor> make_plain_executor(ExecutorKind kind, const ThreadPlaces& places) {
  switch (kind) {
    case ExecutorKind::kTbb:
      return places.binding == ThreadBinding::kNone ? make_tbb_executor(places.thread_count())
                                                    : make_tbb_node_executor(places);
    case ExecutorKind::kOpenMp:
      return make_openmp_executor(places);
    case ExecutorKind::kSerial:
      break;
  }
  if (places.binding != ThreadBinding::kNone) {
    throw std::invalid_argument("a serial executor has no threads to bind");
  }
  return std::make_unique<SerialExecutor>();
}

}  // namespace

std::unique_ptr<Executor> make_executor(ExecutorKind kind, const ThreadPlaces& places) {
#ifdef VANTAGE_THREAD_SANITIZER
  return with_tracing(with_declared_order(make_plain_executor(kind, places)));
#else
  return with_tracing(make_plain_executor(kind, places));
#endif
}

std::unique_ptr<Executor> make_executor(ExecutorKind kind, int threads, ThreadBinding binding) {
  return make_executor(kind, binding == ThreadBinding::kNone
                                 ? unbound_threads(threads)
                                 : place_threads(detect_topology(), threads, binding));
}

}  // namespace vantage::scheduler
