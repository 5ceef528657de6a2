#include "scheduler/executor.h"

#include <algorithm>
#include <iterator>
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

#ifdef VANTAGE_WITH_TBB
std::unique_ptr<Executor> make_tbb(const ThreadPlaces& places) {
  return places.binding == ThreadBinding::kNone ? make_tbb_executor(places.thread_count())
                                                : make_tbb_node_executor(places);
}
#endif

std::unique_ptr<Executor> make_serial(const ThreadPlaces& places) {
  if (places.binding != ThreadBinding::kNone) {
    throw std::invalid_argument("a serial executor has no threads to bind");
  }
  return std::make_unique<SerialExecutor>();
}

struct BuiltInExecutor {
  ExecutorKind kind;
  std::unique_ptr<Executor> (*make)(const ThreadPlaces& places);
};

/// The best first.
constexpr BuiltInExecutor kBuiltIn[] = {
#ifdef VANTAGE_WITH_TBB
    {ExecutorKind::kTbb, make_tbb},
#endif
#ifdef VANTAGE_WITH_OPENMP
    {ExecutorKind::kOpenMp, make_openmp_executor},
#endif
    {ExecutorKind::kSerial, make_serial}};

const BuiltInExecutor& entry_of(ExecutorKind kind) {
  const auto* const found = std::ranges::find(kBuiltIn, kind, &BuiltInExecutor::kind);
  return found == std::end(kBuiltIn) ? kBuiltIn[0] : *found;
}

}  // namespace

ExecutorKind built_in_executor(ExecutorKind wanted) { return entry_of(wanted).kind; }

std::unique_ptr<Executor> make_executor(ExecutorKind kind, const ThreadPlaces& places) {
#ifdef VANTAGE_THREAD_SANITIZER
  return with_tracing(with_declared_order(entry_of(kind).make(places)));
#else
  return with_tracing(entry_of(kind).make(places));
#endif
}

std::unique_ptr<Executor> make_executor(ExecutorKind kind, int threads, ThreadBinding binding) {
  return make_executor(kind, binding == ThreadBinding::kNone
                                 ? unbound_threads(threads)
                                 : place_threads(detect_topology(), threads, binding));
}

}  // namespace vantage::scheduler
