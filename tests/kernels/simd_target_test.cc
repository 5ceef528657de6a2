#include "kernels/simd_target.h"

#include <set>
#include <string_view>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::simd_target_test {

TEST(SimdTarget, AvailableTargetsAreBuiltOnesAndNotEmpty) {
  EXPECT_NE(available_targets(), 0);
  EXPECT_EQ(available_targets() & ~built_targets(), 0);
}

TEST(SimdTarget, EveryTargetRunsWhenForced) {
  for (const long long target : each_target()) {
    force_target(target);
    EXPECT_EQ(target_in_use(), target) << target_name(target);
  }
  force_target(0);
}

TEST(SimdTarget, ZeroChoosesTheBestAgain) {
  // Better targets have lower bits.
  const std::vector<long long> targets = each_target();
  force_target(targets.back());
  force_target(0);
  EXPECT_EQ(target_in_use(), targets.front());
}

TEST(SimdTarget, AskingWhatIsAvailableChangesNothing) {
  const long long all = available_targets();
  for (const long long target : each_target()) {
    force_target(target);
    EXPECT_EQ(available_targets(), all);
    EXPECT_EQ(target_in_use(), target);
  }
  force_target(0);
}

TEST(SimdTarget, NamesTellTargetsApart) {
  std::set<std::string_view> names;
  for (const long long target : each_target()) {
    EXPECT_FALSE(target_name(target).empty());
    EXPECT_TRUE(names.insert(target_name(target)).second) << target_name(target);
  }
}

}  // namespace vantage::kernels::simd_target_test
