#pragma once

#include <memory>
#include <vector>

struct hwloc_topology;
struct hwloc_bitmap_s;

namespace vantage::scheduler {

/// Binds the calling thread to hardware threads from construction to destruction, then lets it run
/// where it ran before. A thread that the system does not let be bound runs on as it is: binding is
/// a matter of speed.
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
