#include "engine/sequence/pairs/frame_poses.h"

#include "tests/engine/engine_test.h"

namespace vantage::frame_poses_test {

Trajectory three_poses(std::vector<double> times_s) {
  Trajectory trajectory{.format = "test", .poses = std::vector<CameraPose>(3), .times_s = {}};
  for (int i = 0; i < 3; ++i) {
    trajectory.poses[static_cast<std::size_t>(i)].translation.x() = i;
  }
  trajectory.times_s = std::move(times_s);
  return trajectory;
}

FramePair pair_of(int index, const char* file) {
  FramePair pair;
  pair.index = index;
  pair.fetched[0].file = file;
  return pair;
}

TEST(FramePoses, BelongToNumbersOrTimes) {
  const FramePoses numbered(three_poses({}), "poses.txt");
  EXPECT_EQ(numbered.of(pair_of(2, "left/10.5.png")).translation.x(), 2);
  EXPECT_EQ(error_of([&] { (void)numbered.of(pair_of(3, "left/000003.png")); }),
            "poses.txt: has 3 poses, expected one for pair 3 (counted from 0)");
  const FramePoses timed(three_poses({10, 10.5, 1403636579.75}), "poses.txt");
  EXPECT_EQ(timed.of(pair_of(2, "left/10.51.png")).translation.x(), 1);
  EXPECT_EQ(timed.of(pair_of(0, "left/1403636579763555584.png")).translation.x(), 2);
  EXPECT_EQ(timed.of(pair_of(0, "left/000012.png")).translation.x(), 0);
  EXPECT_EQ(timed.of(pair_of(1, "")).translation.x(), 1);  // a video
  EXPECT_EQ(error_of([&] { (void)timed.of(pair_of(0, "left/10.250.png")); }),
            "poses.txt: the nearest pose to 10.250.png is 0.250 s away, expected at most 0.02 s");
  FramePoses of_frames(three_poses({}), "poses.txt");
  of_frames.count_frames();
  FramePair after_a_gap = pair_of(1, "left/000002.png");
  after_a_gap.frames = {2, 1};
  EXPECT_EQ(of_frames.of(after_a_gap).translation.x(), 2);
}

}  // namespace vantage::frame_poses_test
