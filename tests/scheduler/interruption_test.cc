#include "scheduler/interruption.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "scheduler/executor.h"

namespace vantage::scheduler::interruption_test {

class InterruptionTest : public testing::TestWithParam<ExecutorKind> {
 protected:
  std::unique_ptr<Executor> executor_ = interruptible(make_executor(GetParam(), 2));
};

void work() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

TEST_P(InterruptionTest, LoopsEndEarly) {
  std::atomic<int> done = 0;
  const std::thread::id thread = std::this_thread::get_id();
  const InterruptibleScope scope([&] {
    EXPECT_EQ(std::this_thread::get_id(), thread);
    return done.load() > 50;
  });
  EXPECT_THROW(executor_->parallel_for(100000,
                                       [&](int) {
                                         work();
                                         ++done;
                                       }),
               Interrupted);
  EXPECT_LT(done.load(), 10000);
}

TEST_P(InterruptionTest, LoopsInsideTasksEndEarly) {
  std::atomic<int> done = 0;
  const InterruptibleScope scope([&] { return done.load() > 50; });
  EXPECT_THROW(executor_->parallel_for(2,
                                       [&](int) {
                                         executor_->parallel_for(50000, [&](int) {
                                           work();
                                           ++done;
                                         });
                                       }),
               Interrupted);
  EXPECT_LT(done.load(), 10000);
}

TEST_P(InterruptionTest, OtherThreadsGoOn) {
  std::atomic<int> done = 0;
  std::thread other([&] {
    executor_->parallel_for(200, [&](int) {
      work();
      ++done;
    });
  });
  {
    const InterruptibleScope scope([] { return true; });
    EXPECT_THROW(executor_->parallel_for(100000, [&](int) { work(); }), Interrupted);
  }
  other.join();
  EXPECT_EQ(done.load(), 200);
  executor_->parallel_for(10, [&](int) { ++done; });
  EXPECT_EQ(done.load(), 210);
}

INSTANTIATE_TEST_SUITE_P(Executors, InterruptionTest,
                         testing::Values(ExecutorKind::kTbb, ExecutorKind::kOpenMp,
                                         ExecutorKind::kSerial));

}  // namespace vantage::scheduler::interruption_test
