#include "scheduler/bound_thread.h"

#include <hwloc.h>

#include <new>
#include <utility>

namespace vantage::scheduler {

BoundThread::BoundThread(std::shared_ptr<hwloc_topology> system, const std::vector<int>& allowed) {
  if (system == nullptr || allowed.empty()) {
    return;
  }
  before_ = hwloc_bitmap_alloc();
  hwloc_bitmap_t wanted = hwloc_bitmap_alloc();
  if (before_ == nullptr || wanted == nullptr) {
    hwloc_bitmap_free(before_);
    hwloc_bitmap_free(wanted);
    throw std::bad_alloc();
  }
  for (const int hardware_thread : allowed) {
    hwloc_bitmap_set(wanted, static_cast<unsigned>(hardware_thread));
  }
  if (hwloc_get_cpubind(system.get(), before_, HWLOC_CPUBIND_THREAD) == 0 &&
      hwloc_set_cpubind(system.get(), wanted, HWLOC_CPUBIND_THREAD) == 0) {
    system_ = std::move(system);
  }
  hwloc_bitmap_free(wanted);
}

BoundThread::~BoundThread() {
  if (system_ != nullptr) {
    hwloc_set_cpubind(system_.get(), before_, HWLOC_CPUBIND_THREAD);
  }
  hwloc_bitmap_free(before_);
}

}  // namespace vantage::scheduler
