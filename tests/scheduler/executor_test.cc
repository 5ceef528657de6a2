#include "scheduler/executor.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <thread>

#include "tests/scheduler/executor_cases.h"

namespace vantage::scheduler::executor_test {

/// Counts the calls of every task.
class Calls {
 public:
  explicit Calls(int tasks) : counts_(static_cast<std::size_t>(tasks)) {}
  void add(int task) { ++counts_.at(task); }
  [[nodiscard]] bool all_are(int count) const {
    for (const std::atomic<int>& calls : counts_) {
      if (calls != count) {
        return false;
      }
    }
    return true;
  }
  [[nodiscard]] int total() const {
    int sum = 0;
    for (const std::atomic<int>& calls : counts_) {
      sum += calls;
    }
    return sum;
  }

 private:
  std::vector<std::atomic<int>> counts_;
};

class ExecutorTest : public testing::TestWithParam<ExecutorCase> {
 protected:
  [[nodiscard]] Executor& executor() { return *executor_; }

 private:
  std::unique_ptr<Executor> executor_ = GetParam().make();
};
INSTANTIATE_TEST_SUITE_P(Kinds, ExecutorTest, testing::ValuesIn(executor_cases()),
                         executor_test_name);

TEST_P(ExecutorTest, SaysWhatItIs) {
  EXPECT_EQ(executor().name(), GetParam().name);
  EXPECT_EQ(executor().thread_count(), GetParam().threads);
}

TEST_P(ExecutorTest, RunsEveryTaskOnce) {
  for (const int tasks : {0, 1, 2, 7, 1000}) {
    Calls calls(tasks);
    executor().parallel_for(tasks, [&](int task) { calls.add(task); });
    EXPECT_TRUE(calls.all_are(1)) << tasks << " tasks";
  }
}

TEST_P(ExecutorTest, HasDoneEverythingWhenItReturns) {
  // Plain memory: what tasks wrote is there for the caller, without any other means.
  std::vector<int> values(1000, 0);
  for (int round = 1; round <= 5; ++round) {
    executor().parallel_for(1000, [&](int task) { values[task] += task; });
    for (int task = 0; task < 1000; ++task) {
      ASSERT_EQ(values[task], round * task);
    }
  }
}

TEST_P(ExecutorTest, NestsLoops) {
  Calls calls(7 * 13 * 3);
  executor().parallel_for(7, [&](int outer) {
    executor().parallel_for(13, [&](int middle) {
      executor().parallel_for(3, [&](int inner) { calls.add((outer * 13 + middle) * 3 + inner); });
    });
    executor().parallel_for(0, [](int) { FAIL(); });
  });
  EXPECT_TRUE(calls.all_are(1));
}

TEST_P(ExecutorTest, UsesNoMoreThreadsThanItHas) {
  std::atomic<int> running{0};
  std::atomic<int> max{0};
  executor().parallel_for(200, [&](int) {
    const int now = ++running;
    for (int seen = max; seen < now && !max.compare_exchange_weak(seen, now);) {
    }
    std::this_thread::yield();
    --running;
  });
  EXPECT_LE(max, GetParam().threads);
}

TEST_P(ExecutorTest, CallersOnSeveralThreadsDoNotDisturbEachOther) {
  if (!GetParam().from_many_threads) {
    GTEST_SKIP() << "the shuffled executor draws orders for one caller";
  }
  Calls calls(3 * 100);
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 3; ++caller) {
    callers.emplace_back([&, caller] {
      executor().parallel_for(100, [&](int task) { calls.add(caller * 100 + task); });
    });
  }
  for (std::thread& caller : callers) {
    caller.join();
  }
  EXPECT_TRUE(calls.all_are(1));
}

TEST_P(ExecutorTest, FirstErrorArrivesAndDropsLaterTasks) {
  constexpr int kTasks = 1000;
  for (int round = 0; round < 3; ++round) {
    std::atomic<int> begun{0};
    std::atomic<bool> thrown{false};
    const auto body = [&](int) {
      if (begun++ == 0) {
        thrown = true;
        throw std::runtime_error("first");
      }
      // Nothing else goes on before the throw; then each task takes a while.
      while (!thrown) {
        std::this_thread::yield();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    try {
      executor().parallel_for(kTasks, body);
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "first");
    }
    EXPECT_LT(begun, kTasks);

    Calls calls(100);
    executor().parallel_for(100, [&](int task) { calls.add(task); });
    EXPECT_TRUE(calls.all_are(1)) << "after an error";
  }
}

TEST_P(ExecutorTest, OneErrorArrivesWhenAllTasksThrow) {
  std::atomic<int> begun{0};
  int caught = 0;
  try {
    executor().parallel_for(50, [&](int) {
      ++begun;
      throw std::out_of_range("all");
    });
  } catch (const std::out_of_range&) {
    ++caught;
  }
  EXPECT_EQ(caught, 1);
  EXPECT_GE(begun, 1);
  EXPECT_LE(begun, GetParam().threads);
}

TEST_P(ExecutorTest, ErrorsOfNestedLoopsCanBeCaughtInTheTask) {
  std::atomic<int> caught{0};
  executor().parallel_for(9, [&](int outer) {
    try {
      executor().parallel_for(5, [&](int inner) {
        if (outer % 2 == 0 && inner == 3) {
          throw std::runtime_error("inner");
        }
      });
    } catch (const std::runtime_error&) {
      ++caught;
    }
  });
  EXPECT_EQ(caught, 5);
}

TEST_P(ExecutorTest, ErrorsOfNestedLoopsLeaveTheOuterLoop) {
  EXPECT_THROW(
      executor().parallel_for(
          4,
          [&](int) { executor().parallel_for(4, [](int) { throw std::runtime_error("inner"); }); }),
      std::runtime_error);
}

TEST(ShuffledExecutor, RunsTasksInAnotherOrderEachTime) {
  const auto order_of = [](Executor& executor) {
    std::vector<int> order;
    executor.parallel_for(100, [&](int task) { order.push_back(task); });
    return order;
  };
  const auto executor = make_shuffled_executor(3);
  const std::vector<int> first = order_of(*executor);
  EXPECT_NE(first, order_of(*executor));
  EXPECT_FALSE(std::is_sorted(first.begin(), first.end()));
  EXPECT_EQ(first, order_of(*make_shuffled_executor(3))) << "the seed decides";
  EXPECT_NE(first, order_of(*make_shuffled_executor(4)));
}

}  // namespace vantage::scheduler::executor_test
