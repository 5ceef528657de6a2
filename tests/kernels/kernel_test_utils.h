#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "kernels/simd_target.h"

namespace vantage::kernels {

/// The instruction sets of this build and machine, one bit each.
inline std::vector<long long> each_target() {
  std::vector<long long> targets;
  const long long all = available_targets();
  for (int bit = 0; bit < 63; ++bit) {
    if (const long long target = 1LL << bit; (all & target) != 0) {
      targets.push_back(target);
    }
  }
  return targets;
}

/// Calls body() once on each instruction set of this machine.
template <typename Body>
void for_each_target(const Body& body) {
  for (const long long target : each_target()) {
    SCOPED_TRACE(target_name(target));
    force_target(target);
    body();
  }
  force_target(0);
}

/// Runs a test on one instruction set and proves that it stayed on it.
class EveryTarget : public ::testing::TestWithParam<long long> {
 protected:
  void SetUp() override {
    force_target(GetParam());
    ASSERT_EQ(target_in_use(), GetParam());
  }
  void TearDown() override {
    EXPECT_EQ(target_in_use(), GetParam());
    force_target(0);
  }
};

inline std::string target_test_name(const ::testing::TestParamInfo<long long>& info) {
  return std::string(target_name(info.param));
}

/// Values that start `offset` elements behind an aligned address and end where the allocation ends,
/// so that the address sanitizer sees any access beyond them.
template <typename T>
class UnalignedRow {
 public:
  UnalignedRow(std::size_t size, std::size_t offset) : memory_(offset + size), offset_(offset) {}

  [[nodiscard]] T* data() { return memory_.data() + offset_; }
  [[nodiscard]] const T* data() const { return memory_.data() + offset_; }
  [[nodiscard]] std::size_t size() const { return memory_.size() - offset_; }
  T& operator[](std::size_t i) { return data()[i]; }
  const T& operator[](std::size_t i) const { return data()[i]; }

 private:
  std::vector<T> memory_;
  std::size_t offset_;
};

/// Equal, or both no number.
template <typename T>
bool is_same(T a, T b) {
  return a == b || (a != a && b != b);
}
template <typename T>
bool are_same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same<T>);
}

/// A row that a kernel writes, between sentinels that it must leave alone.
template <typename T>
class GuardedRow {
 public:
  GuardedRow(std::size_t size, std::size_t offset, T sentinel)
      : memory_(offset + size + kBehind, sentinel),
        size_(size),
        offset_(offset),
        sentinel_(sentinel) {}

  [[nodiscard]] T* data() { return memory_.data() + offset_; }
  [[nodiscard]] std::vector<T> values() const {
    const auto begin = memory_.begin() + static_cast<std::ptrdiff_t>(offset_);
    return {begin, begin + static_cast<std::ptrdiff_t>(size_)};
  }
  [[nodiscard]] bool intact() const {
    const auto is_sentinel = [&](T value) { return value == sentinel_; };
    const auto begin = memory_.begin() + static_cast<std::ptrdiff_t>(offset_);
    return std::all_of(memory_.begin(), begin, is_sentinel) &&
           std::all_of(begin + static_cast<std::ptrdiff_t>(size_), memory_.end(), is_sentinel);
  }

 private:
  static constexpr std::size_t kBehind = 67;
  std::vector<T> memory_;
  std::size_t size_;
  std::size_t offset_;
  T sentinel_;
};

/// What `kernel(arguments..., T* row)` writes to a row of `size` values, which begins at any
/// address. Nothing but the row may change.
template <typename T, typename Kernel, typename... Arguments>
std::vector<T> written_row(std::size_t size, T sentinel, const Kernel& kernel,
                           const Arguments&... arguments) {
  static std::mt19937 random(77);
  GuardedRow<T> row(size, random() % 5, sentinel);
  kernel(arguments..., row.data());
  EXPECT_TRUE(row.intact()) << "changed memory beside a row of " << size;
  return row.values();
}

/// The row that a kernel and its reference write, which must be the same. Different sentinels show
/// what either of them leaves out.
template <typename T, typename Kernel, typename Reference, typename... Arguments>
std::vector<T> equal_rows(std::size_t size, const Kernel& kernel, const Reference& reference,
                          const Arguments&... arguments) {
  const auto expected = written_row(size, static_cast<T>(-99), reference, arguments...);
  EXPECT_EQ(written_row(size, static_cast<T>(77), kernel, arguments...), expected)
      << "row of " << size;
  return expected;
}

/// The row that a kernel writes, which must be the same on every instruction set. Different
/// sentinels show what it leaves out.
template <typename T, typename Kernel, typename... Arguments>
std::vector<T> row_on_every_target(std::size_t size, const Kernel& kernel,
                                   const Arguments&... arguments) {
  const auto expected = written_row(size, static_cast<T>(-99), kernel, arguments...);
  for_each_target([&] {
    EXPECT_TRUE(are_same(written_row(size, static_cast<T>(77), kernel, arguments...), expected))
        << "row of " << size;
  });
  return expected;
}

/// Lane counts below, at and beyond the blocks of vectors that kernels work in.
inline constexpr int kLaneCounts[] = {16, 32, 48, 64, 80, 256};

/// The low 32 bits: what arithmetic "exact modulo 2³²" leaves of `value`.
inline std::int32_t modulo_32_bits(std::int64_t value) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
}

/// An integer in [least, most]. Unlike the standard distributions, the same with every library.
inline int random_int(std::mt19937& random, int min, int max) {
  return min + static_cast<int>(random() % static_cast<unsigned>(max - min + 1));
}

}  // namespace vantage::kernels

/// A suite of tests that run on every instruction set.
#define VANTAGE_ON_EVERY_TARGET(suite)                     \
  class suite : public ::vantage::kernels::EveryTarget {}; \
  VANTAGE_EVERY_TARGET_OF(suite)

/// The same with a fixture of its own, which is derived from EveryTarget.
#define VANTAGE_EVERY_TARGET_OF(suite)                                                             \
  INSTANTIATE_TEST_SUITE_P(Targets, suite, ::testing::ValuesIn(::vantage::kernels::each_target()), \
                           ::vantage::kernels::target_test_name)
