// A caller that wakes helpers leaves its core to them if they do not come.
#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "scheduler/helper_arrival.h"

namespace vantage::scheduler {
namespace helper_arrival_test {

cpu_set_t own_mask() {
  cpu_set_t mask;
  CPU_ZERO(&mask);
  EXPECT_EQ(sched_getaffinity(0, sizeof mask, &mask), 0);
  return mask;
}

void wait_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

TEST(HelperArrival, ThreadsLeaveTheirCoreAndMayReturn) {
  const cpu_set_t before = own_mask();
  int moves = 0;
  for (int k = 0; k < 20; ++k) {
    const int core = sched_getcpu();
    EXPECT_EQ(leave_core(), CPU_COUNT(&before) > 1);
    moves += sched_getcpu() != core ? 1 : 0;
    const cpu_set_t after = own_mask();
    EXPECT_TRUE(CPU_EQUAL(&before, &after));
  }
  if (CPU_COUNT(&before) > 1) {
    EXPECT_GT(moves, 10) << "of 20; a few may have been moved back at once";
  }
}

TEST(HelperArrival, ThreadsWithOneCoreStay) {
  std::thread([] {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<unsigned>(sched_getcpu()), &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_FALSE(leave_core());
    const cpu_set_t after = own_mask();
    EXPECT_TRUE(CPU_EQUAL(&one, &after));
  }).join();
}

constexpr std::chrono::microseconds kNone{0};
constexpr std::chrono::hours kLong{1};
bool move() { return true; }

TEST(HelperArrival, CallersMoveOnceAfterAPauseIfNobodyComes) {
  HelperArrival arrival(kNone, kNone, move);
  for (int pause = 0; pause < 2; ++pause) {
    wait_ms(1);
    const HelperArrival::Work work(arrival, true);
    wait_ms(1);
    EXPECT_TRUE(arrival.note_task());
    EXPECT_FALSE(arrival.note_task());
    wait_ms(1);
    const HelperArrival::Work inner(arrival, true);
    wait_ms(1);
    EXPECT_FALSE(arrival.note_task()) << "the outer work goes on: no pause";
  }
}

TEST(HelperArrival, CallersStay) {
  {
    HelperArrival arrival(kNone, kNone, move);
    const HelperArrival::Work work(arrival, true);
    std::thread([&] { EXPECT_FALSE(arrival.note_task()) << "the helper itself"; }).join();
    wait_ms(1);
    EXPECT_FALSE(arrival.note_task()) << "a helper came";
  }
  {
    HelperArrival arrival(kNone, kNone, move);
    const HelperArrival::Work work(arrival, false);
    wait_ms(1);
    EXPECT_FALSE(arrival.note_task()) << "nobody is expected";
  }
  {
    HelperArrival arrival(kNone, kLong, move);
    const HelperArrival::Work work(arrival, true);
    wait_ms(1);
    EXPECT_FALSE(arrival.note_task()) << "too soon";
  }
  HelperArrival arrival(kLong, kNone, move);
  { const HelperArrival::Work first(arrival, false); }
  const HelperArrival::Work work(arrival, true);
  wait_ms(1);
  EXPECT_FALSE(arrival.note_task()) << "no pause";
}

/// More threads than cores want to run.
TEST(HelperArrival, NobodyMovesToABusyCore) {
  const cpu_set_t mask = own_mask();
  std::atomic<bool> ends{false};
  std::vector<std::thread> busy;
  for (int k = 0; k < CPU_COUNT(&mask) + 1; ++k) {
    busy.emplace_back([&ends] {
      while (!ends) {
      }
    });
  }
  wait_ms(20);
  EXPECT_FALSE(move_to_idle_core());
  ends = true;
  for (std::thread& thread : busy) {
    thread.join();
  }
}

}  // namespace helper_arrival_test
}  // namespace vantage::scheduler
