#include "engine/profiling/roofline.h"

#include "tests/engine/engine_test.h"

namespace vantage::roofline_test {

// Peak 100 GFLOP/s, L2 50 GB/s, memory 5 GB/s each: with 2 operations per byte both upper roofs
// meet.
constexpr ThreadRoofs kRoofs = {.gflops = 100, .l2_gb_per_s = 50, .memory_gb_per_s = 5};

StageProfile stage(double seconds, double operations, double bytes) {
  StageProfile stage;
  stage.seconds = {seconds, seconds, seconds};
  stage.operations = operations;
  stage.bytes = bytes;
  return stage;
}

TEST(Roofline, AThreadsShareIsThatOfAllThreads) {
  const ThreadRoofs roofs = thread_roofs({.threads = 4,
                                          .core_gflops = 120,
                                          .all_gflops = 400,
                                          .core_l2_gb_per_s = 70,
                                          .all_l2_gb_per_s = 200,
                                          .core_memory_gb_per_s = 15,
                                          .all_memory_gb_per_s = 20});
  EXPECT_DOUBLE_EQ(roofs.gflops, 100);
  EXPECT_DOUBLE_EQ(roofs.l2_gb_per_s, 50);
  EXPECT_DOUBLE_EQ(roofs.memory_gb_per_s, 5);
}

TEST(Roofline, ManyOperationsPerByteAreBelowArithmetic) {
  const auto place = place_on_roofline(stage(2, 120e9, 12e9), kRoofs);
  ASSERT_TRUE(place.has_value());
  EXPECT_DOUBLE_EQ(place->operations_per_byte, 10);
  EXPECT_DOUBLE_EQ(place->gflops, 60);
  EXPECT_DOUBLE_EQ(place->gb_per_s, 6);
  EXPECT_EQ(place->roof, Roof::kArithmetic);
  EXPECT_DOUBLE_EQ(place->roof_gflops, 100);
  EXPECT_DOUBLE_EQ(place->roof_share, 0.6);
  EXPECT_DOUBLE_EQ(place->memory_share, 1.2);
}

TEST(Roofline, FewOperationsPerByteAreBelowLevel2) {
  const auto place = place_on_roofline(stage(1, 20e9, 40e9), kRoofs);
  ASSERT_TRUE(place.has_value());
  EXPECT_EQ(place->roof, Roof::kL2);
  EXPECT_DOUBLE_EQ(place->roof_gflops, 25);
  EXPECT_DOUBLE_EQ(place->roof_share, 0.8);
}

TEST(Roofline, WhatMovesMoreThanLevel2DeliversIsBelowArithmetic) {
  const auto place = place_on_roofline(stage(1, 40e9, 80e9), kRoofs);
  ASSERT_TRUE(place.has_value());
  EXPECT_EQ(place->roof, Roof::kArithmetic);
  EXPECT_DOUBLE_EQ(place->roof_share, 0.4);
}

TEST(Roofline, StagesWithoutWorkOrTimeHaveNoPlace) {
  EXPECT_FALSE(place_on_roofline(stage(0, 1e9, 1e9), kRoofs).has_value());
  EXPECT_FALSE(place_on_roofline(stage(1, 0, 1e9), kRoofs).has_value());
  EXPECT_FALSE(place_on_roofline(stage(1, 1e9, 0), kRoofs).has_value());
}

TEST(Roofline, RoofsAreThoseMeasuredOnAsManyThreads) {
  Profile profile;
  EXPECT_FALSE(roofs_on(profile, 2).has_value());
  profile.ceilings = {{1, 10, 10, 10, 10, 10, 10}, {2, 10, 18, 10, 16, 10, 12}};
  const auto roofs = roofs_on(profile, 2);
  ASSERT_TRUE(roofs.has_value());
  EXPECT_DOUBLE_EQ(roofs->gflops, 9);
  EXPECT_DOUBLE_EQ(roofs->l2_gb_per_s, 8);
  EXPECT_DOUBLE_EQ(roofs->memory_gb_per_s, 6);
  EXPECT_FALSE(roofs_on(profile, 4).has_value());
  profile.ceilings[1].all_l2_gb_per_s = 0;
  EXPECT_FALSE(roofs_on(profile, 2).has_value());
}

}  // namespace vantage::roofline_test
