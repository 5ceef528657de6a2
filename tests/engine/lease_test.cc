#include "engine/io/store/lease.h"

#include "engine/io/store/folder_store.h"
#include "tests/engine/engine_test.h"

namespace vantage::lease_test {

using Seconds = std::chrono::duration<double>;

/// Two workers of one folder.
class LeaseTest : public testing::Test {
 protected:
  TemporaryFolder folder_;
  FolderStore store_{folder_.path()};
  Leases first_{store_, "leases/", "first", Seconds(0.4)};
  Leases second_{store_, "leases/", "second", Seconds(0.4)};
  /// Of a worker that has died: nothing shows its life.
  void die(const std::string& name, int generation) {
    store_.put_text("leases/" + name + "/00000" + std::to_string(generation), "dead", {});
  }
};

TEST_F(LeaseTest, OneOfTwoHasIt) {
  const auto held = first_.take("job");
  ASSERT_NE(held, nullptr);
  EXPECT_EQ(held->abandoned(), 0);
  EXPECT_EQ(second_.take("job"), nullptr);  // which had not looked
  second_.look();
  EXPECT_FALSE(second_.may_be_free("job"));
  EXPECT_NE(second_.take("other"), nullptr);
}

TEST_F(LeaseTest, WhoShowsLifeKeepsIt) {
  const auto held = first_.take("job");
  for (int look = 0; look < 8; ++look) {
    second_.look();
    EXPECT_EQ(second_.take("job"), nullptr) << look;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

TEST_F(LeaseTest, TheDeadAreFollowed) {
  die("job", 1);
  second_.look();
  EXPECT_EQ(second_.take("job"), nullptr);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_FALSE(second_.may_be_free("job"));  // whoever does not look does not know
  second_.look();
  first_.look();
  const auto taken = second_.take("job");
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->abandoned(), 1);
  EXPECT_EQ(first_.take("job"), nullptr);
}

TEST_F(LeaseTest, WhatIsHandedBackIsFreeAtOnceAndNobodyDied) {
  first_.take("job")->hand_back();
  second_.look();
  const auto taken = second_.take("job");
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->abandoned(), 0);
  die("job", 3);
  taken->finish();
  first_.look();
  EXPECT_NE(first_.take("job"), nullptr);  // as if it were new
}

}  // namespace vantage::lease_test
