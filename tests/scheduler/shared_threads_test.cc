#include "scheduler/shared_threads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "scheduler/executor.h"
#include "scheduler/interruption.h"

namespace vantage::scheduler::shared_threads_test {

void sleep_ms(int duration_ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(duration_ms));
}

/// Counts how many threads work at a time.
class WorkCount {
 public:
  void work_ms(int duration_ms) {
    const int now = ++working_;
    int most = most_.load();
    while (now > most && !most_.compare_exchange_weak(most, now)) {
    }
    sleep_ms(duration_ms);
    --working_;
  }
  [[nodiscard]] int most() const { return most_.load(); }

 private:
  std::atomic<int> working_ = 0;
  std::atomic<int> most_ = 0;
};

class SharedThreadsTest : public testing::TestWithParam<ExecutorKind> {
 protected:
  void use(int thread_count) {
    auto inner = make_executor(GetParam(), thread_count);
    threads_ = std::make_unique<SharedThreads>(inner->thread_count());
    executor_ = interruptible(sharing(std::move(inner), *threads_));
  }

  std::unique_ptr<SharedThreads> threads_;
  std::unique_ptr<Executor> executor_;
};

TEST_P(SharedThreadsTest, NoMoreWorkThanTheExecutorHas) {
  for (const auto& [thread_count, callers] : {std::pair(1, 3), {2, 2}, {3, 2}, {3, 7}, {5, 3}}) {
    use(thread_count);
    WorkCount count;
    std::atomic<int> done = 0;
    std::vector<std::thread> threads;
    for (int caller = 0; caller < callers; ++caller) {
      threads.emplace_back([&] {
        for (int repeat = 0; repeat < 3; ++repeat) {
          const SharedThreads::Call call(*threads_);
          count.work_ms(1);
          executor_->parallel_for(13, [&](int) {
            count.work_ms(1);
            ++done;
          });
          const SharedThreads::Call inner(*threads_);
          executor_->parallel_for(2, [&](int) { count.work_ms(1); });
        }
      });
    }
    std::for_each(threads.begin(), threads.end(), [](std::thread& thread) { thread.join(); });
    EXPECT_EQ(done.load(), callers * 3 * 13);
    EXPECT_LE(count.most(), executor_->thread_count()) << thread_count << ", " << callers;
  }
}

TEST_P(SharedThreadsTest, LoopOfTheOnlyCallUsesAllThreads) {
  use(4);
  std::mutex mutex;
  std::set<std::thread::id> ids;
  const SharedThreads::Call call(*threads_);
  for (int repeat = 0; repeat < 50 && static_cast<int>(ids.size()) < executor_->thread_count();
       ++repeat) {
    executor_->parallel_for(40, [&](int) {
      sleep_ms(1);
      const std::lock_guard lock(mutex);
      ids.insert(std::this_thread::get_id());
    });
  }
  EXPECT_EQ(static_cast<int>(ids.size()), executor_->thread_count());
}

TEST_P(SharedThreadsTest, CallsHaveTheirTurn) {
  use(1);
  std::atomic<bool> waits = false;
  std::atomic<bool> done = false;
  auto call = std::make_unique<SharedThreads::Call>(*threads_);
  std::thread other([&] {
    waits = true;
    const SharedThreads::Call waiting(*threads_);
    done = true;
  });
  while (!waits) {
    std::this_thread::yield();
  }
  // Who releases its thread and wants one at once comes after who has waited.
  int turns = 0;
  for (; !done && turns < 1000; ++turns) {
    sleep_ms(1);
    call.reset();
    call = std::make_unique<SharedThreads::Call>(*threads_);
  }
  call.reset();
  other.join();
  EXPECT_LT(turns, 1000);
}

TEST_P(SharedThreadsTest, InterruptionEndsTheWait) {
  use(1);
  {
    const SharedThreads::Call call(*threads_);
    std::thread([&] {
      const InterruptibleScope scope([] { return true; });
      EXPECT_THROW(const SharedThreads::Call waiting(*threads_), Interrupted);
    }).join();
  }
  std::thread([&] { const SharedThreads::Call call(*threads_); }).join();
}

TEST_P(SharedThreadsTest, ErrorsOfTasksEndTheLoopAndFreeItsThreads) {
  use(4);
  // Two calls: each loop has a part of the threads.
  std::atomic<bool> done = false;
  std::thread other([&] {
    const SharedThreads::Call call(*threads_);
    while (!done) {
      sleep_ms(1);
    }
  });
  {
    const SharedThreads::Call call(*threads_);
    std::atomic<int> count = 0;
    EXPECT_THROW(executor_->parallel_for(10000,
                                         [&](int task) {
                                           if (task == 5) {
                                             throw std::runtime_error("task 5");
                                           }
                                           sleep_ms(1);
                                           ++count;
                                         }),
                 std::runtime_error);
    EXPECT_LT(count.load(), 5000);
  }
  done = true;
  other.join();
  // No thread is lost: as many calls as there are threads at a time.
  std::atomic<int> inside = 0;
  std::vector<std::thread> callers;
  for (int caller = 0; caller < executor_->thread_count(); ++caller) {
    callers.emplace_back([&] {
      const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(20);
      const InterruptibleScope scope([&] { return std::chrono::steady_clock::now() > give_up; });
      try {
        const SharedThreads::Call call(*threads_);
        ++inside;
        while (inside.load() < executor_->thread_count()) {
          sleep_ms(1);
          check_interruption();
        }
      } catch (const Interrupted&) {
        ADD_FAILURE() << inside.load() << " threads are free";
      }
    });
  }
  std::for_each(callers.begin(), callers.end(), [](std::thread& caller) { caller.join(); });
}

INSTANTIATE_TEST_SUITE_P(Executors, SharedThreadsTest,
                         testing::Values(ExecutorKind::kTbb, ExecutorKind::kOpenMp,
                                         ExecutorKind::kSerial));

}  // namespace vantage::scheduler::shared_threads_test
