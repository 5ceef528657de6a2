#pragma once

#include <memory>
#include <vector>

struct hwloc_topology;
struct hwloc_bitmap_s;

namespace vantage::scheduler {

/// Binds the calling thread to hardware threads while it exists, then restores the previous
/// affinity, so neither callers nor TBB's workers stay bound. If the system refuses, the thread
/// stays as it is: binding affects speed only.
class BoundThread {
 public:
  /// Does nothing.
  BoundThread() = default;
  /// `system`: a loaded topology of this system; null, or an empty `allowed`: does nothing.
  BoundThread(std::shared_ptr<hwloc_topology> system, const std::vector<int>& allowed);
  BoundThread(const BoundThread&) = delete;
  BoundThread& operator=(const BoundThread&) = delete;
  ~BoundThread();

 private:
  std::shared_ptr<hwloc_topology> system_;  // null: not bound
  hwloc_bitmap_s* before_ = nullptr;
};

}  // namespace vantage::scheduler
