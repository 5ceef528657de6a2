#pragma once

#include <atomic>
#include <optional>
#include <vector>

namespace vantage::scheduler {

/// The tasks of a loop, a contiguous range for each NUMA node. Neighbouring tasks share rows, so a
/// node continues where its own threads have written. An idle node takes tasks from the node with
/// the most tasks left. Thread rule: all members may be called concurrently.
class TaskRanges {
 public:
  /// Ranges are in proportion to the threads of the nodes.
  TaskRanges(int task_count, const std::vector<int>& threads_of_nodes);

  /// The next task for a thread of `node`; empty when all are taken.
  std::optional<int> take(int node);
  /// Takes all remaining tasks and returns their number.
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
