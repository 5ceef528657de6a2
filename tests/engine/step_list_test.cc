// The list of the steps of a frame: what reports call them, and that its order is that of the
// pipeline.

#include "engine/sequence/steps/step_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "engine/sequence/steps/step_accounts.h"

namespace vantage::step_list_test {

TEST(StepList, AccountsHaveTheOrderOfTheSteps) {
  const StepAccounts accounts;
  std::vector<std::string_view> names;
  for (const StepAccounts::Account& account : accounts.all()) {
    names.push_back(account.name);
  }
  EXPECT_THAT(names, testing::ElementsAre("read", "decode", "rectify", "match", "views", "pictures",
                                          "comfort", "encode", "write", "deliver"));
}

TEST(StepList, FollowsThePipeline) {
  EXPECT_TRUE(std::ranges::is_sorted(frame_steps(), {}, &StepEntry::phase));
  for (const StepEntry& step : frame_steps()) {
    const bool is_in_order = step.phase == StepPhase::kRead || step.phase == StepPhase::kWrite;
    EXPECT_EQ(step.make == nullptr, is_in_order) << step.account;
  }
}

}  // namespace vantage::step_list_test
