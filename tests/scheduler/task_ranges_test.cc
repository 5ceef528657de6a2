#include "scheduler/task_ranges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <thread>
#include <vector>

namespace vantage::scheduler::task_ranges_test {

using testing::ElementsAre;

/// What a thread of `node` gets, alone, one after the other.
std::vector<int> taken_by(TaskRanges& tasks, int node, int max = 1000) {
  std::vector<int> taken;
  while (static_cast<int>(taken.size()) < max) {
    const std::optional<int> task = tasks.take(node);
    if (!task) {
      break;
    }
    taken.push_back(*task);
  }
  return taken;
}

TEST(TaskRanges, GivesEachNodeItsShareInOneStretch) {
  TaskRanges tasks(10, {2, 3});
  EXPECT_THAT(taken_by(tasks, 1, 6), ElementsAre(4, 5, 6, 7, 8, 9));
  EXPECT_THAT(taken_by(tasks, 0, 4), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(tasks.take(0), std::nullopt);
  EXPECT_EQ(tasks.take(1), std::nullopt);
}

TEST(TaskRanges, HelpsWhoHasMostLeft) {
  TaskRanges tasks(9, {1, 1, 1});
  EXPECT_THAT(taken_by(tasks, 1, 2), ElementsAre(3, 4));
  // Its own, then those of node 2, which has more left than node 1.
  EXPECT_THAT(taken_by(tasks, 0),
              ElementsAre(0, 1, 2, 6, 7, testing::AnyOf(5, 8), testing::AnyOf(5, 8)));
  EXPECT_EQ(tasks.take(2), std::nullopt);
}

TEST(TaskRanges, CountsWhatItTakesAtOnce) {
  TaskRanges tasks(7, {1, 2});
  taken_by(tasks, 0, 1);
  EXPECT_EQ(tasks.take_all(), 6);
  EXPECT_EQ(tasks.take_all(), 0);
  EXPECT_EQ(tasks.take(1), std::nullopt);
}

TEST(TaskRanges, ManyThreadsGetEveryTaskOnce) {
  constexpr int kTasks = 20000;
  TaskRanges tasks(kTasks, {2, 1, 3});
  std::vector<std::atomic<int>> taken(kTasks);
  std::vector<std::thread> threads;
  threads.reserve(6);
  for (int thread = 0; thread < 6; ++thread) {
    threads.emplace_back([&, thread] {
      while (const std::optional<int> task = tasks.take(thread % 3)) {
        ++taken.at(*task);
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_THAT(taken, testing::Each(testing::Truly([](const auto& count) { return count == 1; })));
}

}  // namespace vantage::scheduler::task_ranges_test
