#include "scheduler/processor_account.h"

#include <ctime>

#include "tests/scheduler/executor_cases.h"

namespace vantage::scheduler::processor_account_test {

double processor_seconds(clockid_t clock) {
  timespec time{};
  ::clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Computes for that much processor time.
void work(double seconds) {
  const double end = processor_seconds(CLOCK_THREAD_CPUTIME_ID) + seconds;
  while (processor_seconds(CLOCK_THREAD_CPUTIME_ID) < end) {
  }
}

class ProcessorAccounts : public testing::TestWithParam<ExecutorCase> {};
INSTANTIATE_TEST_SUITE_P(Executors, ProcessorAccounts, testing::ValuesIn(executor_cases()),
                         executor_test_name);

TEST_P(ProcessorAccounts, HoldTheTimeOfTheTasks) {
  if (GetParam().name == "shuffled") {
    GTEST_SKIP() << "made without make_executor()";
  }
  constexpr int kTasks = 6;
  constexpr double kTaskSeconds = 0.001;
  const auto executor = GetParam().make();
  ProcessorAccount tasks;
  ProcessorAccount inner;
  {
    const ProcessorCharge charge(&tasks);
    executor->parallel_for(kTasks, [&](int) {
      work(kTaskSeconds);
      const ProcessorCharge of_part(&inner);
      work(2 * kTaskSeconds);
    });
    EXPECT_EQ(ProcessorCharge::account_in_use(), &tasks);
  }
  EXPECT_EQ(ProcessorCharge::account_in_use(), nullptr);
  work(kTaskSeconds);  // for nobody
  EXPECT_GE(tasks.seconds(), kTasks * kTaskSeconds);
  EXPECT_GE(inner.seconds(), 2 * kTasks * kTaskSeconds);
  // Waiting threads may look for work, so there is no tight upper limit of the loop's own.
  EXPECT_LE(inner.seconds(), 4 * kTasks * kTaskSeconds);
}

}  // namespace vantage::scheduler::processor_account_test
