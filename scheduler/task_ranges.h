#pragma once

#include <atomic>
#include <optional>
#include <vector>

namespace vantage::scheduler {

/// The tasks of a loop, a contiguous range of them for each NUMA node. Neighbouring tasks share
/// rows, so a node goes on where its own threads have been writing; one that is done helps the node
/// that has most left. Thread rule: all members may be called concurrently.
class TaskRanges {
 public:
  /// Ranges are in proportion to the threads of the nodes.
  TaskRanges(int task_count, const std::vector<int>& threads_of_nodes);

  /// A task that nobody else has, for a thread of `node`; nothing when all are taken.
  std::optional<int> take(int node);
  /// Takes all that are left; how many that were.
  int take_all();

 private:
  struct alignas(64) Range {  // a cache line each
    std::atomic<int> next{0};
    int end = 0;
  };

  static std::optional<int> take_from(Range& range);

  std::vector<Range> ranges_;
};

}  // namespace vantage::scheduler
