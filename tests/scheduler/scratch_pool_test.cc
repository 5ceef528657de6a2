#include "scheduler/scratch_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace vantage::scheduler::scratch_pool_test {

TEST(ScratchPool, MemoryIsAlignedAndWritable) {
  ScratchPool pool;
  for (const std::size_t bytes : {0, 1, 63, 64, 65, 1000, 100001}) {
    const ScratchPool::Lease lease = pool.lease(bytes);
    ASSERT_NE(lease.data(), nullptr);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(lease.data()) % ScratchPool::kAlignment, 0U);
    std::memset(lease.data(), 0x5A, bytes);
  }
}

TEST(ScratchPool, LeasesDoNotOverlap) {
  ScratchPool pool;
  std::vector<ScratchPool::Lease> leases;
  for (unsigned char i = 0; i < 20; ++i) {
    leases.push_back(pool.lease(100));
    std::memset(leases.back().data(), i, 100);
  }
  for (unsigned char i = 0; i < 20; ++i) {
    for (std::size_t k = 0; k < 100; ++k) {
      ASSERT_EQ(leases[i].data()[k], std::byte{i});
    }
  }
}

TEST(ScratchPool, SteadyTasksAllocateNothing) {
  ScratchPool pool;
  std::set<std::byte*> first_round;
  std::size_t held = 0;
  for (int round = 0; round < 10; ++round) {
    std::vector<ScratchPool::Lease> leases;
    std::set<std::byte*> blocks;
    for (const std::size_t bytes : {4096, 128, 4096, 1000}) {
      leases.push_back(pool.lease(bytes));
      blocks.insert(leases.back().data());
    }
    if (round == 0) {
      first_round = blocks;
      held = pool.bytes_held();
    }
    EXPECT_EQ(blocks, first_round);
    EXPECT_EQ(pool.bytes_held(), held);
  }
}

TEST(ScratchPool, TakesTheSmallestBlockThatFits) {
  ScratchPool pool;
  std::byte* small = nullptr;
  std::byte* large = nullptr;
  {
    const ScratchPool::Lease a = pool.lease(10000);
    const ScratchPool::Lease b = pool.lease(500);
    large = a.data();
    small = b.data();
  }
  const ScratchPool::Lease b = pool.lease(400);
  const ScratchPool::Lease a = pool.lease(9000);
  EXPECT_EQ(b.data(), small);
  EXPECT_EQ(a.data(), large);
}

TEST(ScratchPool, LetsBlocksGoThatHaveBecomeTooSmall) {
  ScratchPool pool;
  for (std::size_t bytes = 1024; bytes <= 1024 * 1024; bytes *= 2) {
    const ScratchPool::Lease lease = pool.lease(bytes);
    EXPECT_EQ(pool.bytes_held(), bytes);
  }
}

TEST(ScratchPool, LeasesMove) {
  ScratchPool pool;
  ScratchPool::Lease a = pool.lease(100);
  std::byte* const memory = a.data();
  ScratchPool::Lease b = std::move(a);
  EXPECT_EQ(b.data(), memory);
  ScratchPool::Lease c;
  EXPECT_EQ(c.data(), nullptr);
  c = std::move(b);
  EXPECT_EQ(c.data(), memory);
  c = ScratchPool::Lease();
  EXPECT_EQ(pool.lease(100).data(), memory) << "given back when assigned to";
}

TEST(ScratchPool, ServesManyThreads) {
  ScratchPool pool;
  std::atomic<int> overwritten{0};
  std::vector<std::thread> threads;
  for (unsigned char id = 1; id <= 4; ++id) {
    threads.emplace_back([&, id] {
      for (std::size_t round = 0; round < 200; ++round) {
        const std::size_t bytes = 64 + round % 7 * 100;
        const ScratchPool::Lease lease = pool.lease(bytes);
        std::memset(lease.data(), id, bytes);
        std::this_thread::yield();
        for (std::size_t k = 0; k < bytes; ++k) {
          overwritten += lease.data()[k] == std::byte{id} ? 0 : 1;
        }
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(overwritten, 0);
  EXPECT_LE(pool.bytes_held(), 4U * 700U) << "one block per thread at most";
}

TEST(ScratchPool, KnowsTheMostThatWasLeasedForAUse) {
  ScratchPool pool;
  {
    const ScratchPool::Lease rings = pool.lease(1000, ScratchUse::kRings);
    const ScratchPool::Lease more_rings = pool.lease(2000, ScratchUse::kRings);
    const ScratchPool::Lease stored = pool.lease(64, ScratchUse::kStored);
  }
  const ScratchPool::Lease again = pool.lease(1000, ScratchUse::kRings);
  EXPECT_EQ(pool.max_leased_bytes(ScratchUse::kRings), 3000U);
  EXPECT_EQ(pool.max_leased_bytes(ScratchUse::kStored), 64U);
  EXPECT_EQ(pool.max_leased_bytes(ScratchUse::kOther), 0U);
}

}  // namespace vantage::scheduler::scratch_pool_test
