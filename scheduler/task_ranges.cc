#include "scheduler/task_ranges.h"

#include <algorithm>
#include <cstddef>

#include "scheduler/thread_places.h"

namespace vantage::scheduler {

TaskRanges::TaskRanges(int task_count, const std::vector<int>& threads_of_nodes)
    : ranges_(threads_of_nodes.size()) {
  const std::vector<int> counts = divide_in_proportion(task_count, threads_of_nodes);
  int first = 0;
  for (std::size_t node = 0; node < ranges_.size(); ++node) {
    ranges_[node].next = first;
    first += counts[node];
    ranges_[node].end = first;
  }
}

std::optional<int> TaskRanges::take_from(Range& range) {
  // Without a look first, threads that find nothing would make the counter grow for ever.
  if (range.next.load(std::memory_order_relaxed) >= range.end) {
    return std::nullopt;
  }
  const int task = range.next.fetch_add(1);
  return task < range.end ? std::optional(task) : std::nullopt;
}

std::optional<int> TaskRanges::take(int node) {
  std::optional<int> task = take_from(ranges_[static_cast<std::size_t>(node)]);
  while (!task) {
    const auto left = [](const Range& range) { return range.end - range.next.load(); };
    Range& fullest = *std::ranges::max_element(ranges_, {}, left);
    if (left(fullest) <= 0) {
      break;
    }
    task = take_from(fullest);
  }
  return task;
}

int TaskRanges::take_all() {
  int count = 0;
  for (Range& range : ranges_) {
    count += std::max(0, range.end - range.next.exchange(range.end));
  }
  return count;
}

}  // namespace vantage::scheduler
