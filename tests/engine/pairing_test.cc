// Pairs of made-up frames: bad ones, gaps in time, ends that come early.

#include "engine/sequence/pairs/moving_camera_pairs.h"
#include "engine/sequence/pairs/packed_pairs.h"
#include "engine/sequence/pairs/several_cameras.h"
#include "engine/sequence/pairs/streamed_pairs.h"
#include "engine/sequence/pairs/two_camera_pairs.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/frame_test_support.h"
#include "tests/engine/made_up_pairs.h"

namespace vantage::pairing_test {

/// A video whose frames have their index as value.
class MadeUpVideo : public FrameSource {
 public:
  MadeUpVideo(std::string name, int frame_count)
      : name_(std::move(name)), frame_count_(frame_count) {}

  bool fetch(FetchedFrame& frame) override {
    if (next_ == std::min(frame_count_, true_count)) {
      return false;
    }
    const int index = next_++;
    ++fetched;
    if (bad.contains(index)) {
      throw Error(describe(index) + " is bad");
    }
    frame.picture = plain_picture(2, 2, index);
    frame.frames_missing = missing.contains(index) ? missing[index] : 0;
    frame.remarks.assign(frame.frames_missing > 0 ? 1 : 0, describe(index) + " comes late");
    return true;
  }
  void skip_to(int index) override { next_ = index; }
  [[nodiscard]] int frame_count() const override { return frame_count_; }
  [[nodiscard]] std::string describe(int index) const override {
    return name_ + " " + std::to_string(index);
  }
  [[nodiscard]] std::optional<long long> number_of(int) const override { return std::nullopt; }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override { return FrameRate{}; }
  [[nodiscard]] std::filesystem::path video_file() const override { return name_; }
  [[nodiscard]] std::string identity() const override { return "video " + name_; }

  std::set<int> bad;
  std::map<int, int> missing;  ///< frames missing before this one
  int true_count = 1000;
  int fetched = 0;

 private:
  std::string name_;
  int frame_count_;
  int next_ = 0;
};

TwoCameraPairs paired(std::unique_ptr<FrameSource> left, std::unique_ptr<FrameSource> right,
                      int offset_frames) {
  FramePairing pairing = pair_frames({left.get(), right.get()}, offset_frames, std::nullopt);
  return TwoCameraPairs(std::move(left), std::move(right), std::move(pairing));
}

/// "0 1" for the values of a pair, or what is wrong.
std::vector<std::string> outcomes_of(PairSource& source) {
  std::vector<std::string> outcomes;
  FramePair pair;
  for (;;) {
    try {
      if (!source.fetch(pair)) {
        return outcomes;
      }
      source.decode(pair);
      outcomes.push_back(std::to_string(value_of(pair.left)) + " " +
                         std::to_string(value_of(pair.right)));
    } catch (const Error& error) {
      outcomes.push_back(std::to_string(pair.index) + ": " + error.what());
    }
  }
}

std::map<int, std::vector<std::string>> remarks_of(PairSource& source) {
  std::map<int, std::vector<std::string>> remarks;
  for (FramePair pair; source.fetch(pair);) {
    if (!pair.remarks.empty()) {
      remarks[pair.index] = pair.remarks;
    }
  }
  return remarks;
}

TEST(TwoCameraPairs, BothSidesStayInStepBehindABadFrame) {
  auto left = std::make_unique<MadeUpVideo>("l", 5);
  auto right = std::make_unique<MadeUpVideo>("r", 5);
  left->bad = {1, 3};
  right->bad = {2, 3};
  TwoCameraPairs pairs = paired(std::move(left), std::move(right), 0);
  EXPECT_THAT(outcomes_of(pairs),
              ElementsAre("0 0", "1: l 1 is bad", "2: r 2 is bad", "3: l 3 is bad", "4 4"));
}

TEST(TwoCameraPairs, EndsWithTheSideThatEndsFirst) {
  auto left = std::make_unique<MadeUpVideo>("l", 5);
  auto right = std::make_unique<MadeUpVideo>("r", 5);
  right->true_count = 3;
  TwoCameraPairs pairs = paired(std::move(left), std::move(right), 1);
  EXPECT_EQ(pairs.pair_count(), 4);
  EXPECT_THAT(outcomes_of(pairs), ElementsAre("0 1", "1 2"));
}

TEST(TwoCameraPairs, FramesMissingOnOneSideAreRemarked) {
  auto left = std::make_unique<MadeUpVideo>("l", 6);
  auto right = std::make_unique<MadeUpVideo>("r", 6);
  left->missing = {{1, 2}, {3, 1}};
  right->missing = {{3, 1}, {4, 1}};
  TwoCameraPairs pairs = paired(std::move(left), std::move(right), 0);
  const std::map<int, std::vector<std::string>> remarks = remarks_of(pairs);
  ASSERT_EQ(remarks.size(), 3U);
  EXPECT_THAT(
      remarks.at(1),
      ElementsAre("l 1 comes late",
                  "2 more frames are missing in the left video than in the right one before "
                  "pair 1: from here on the pairs may not be of the same moment"));
  EXPECT_THAT(remarks.at(3), ElementsAre("l 3 comes late", "r 3 comes late"));
  EXPECT_THAT(
      remarks.at(4),
      ElementsAre("r 4 comes late",
                  HasSubstr("1 more frame is missing in the right video than in the left")));
  EXPECT_THAT(pairs.remarks(), IsEmpty());
}

TEST(SeveralCameras, FurtherCamerasStayInStepBehindABadFrame) {
  auto left = std::make_unique<MadeUpVideo>("l", 6);
  auto right = std::make_unique<MadeUpVideo>("r", 6);
  auto third = std::make_unique<MadeUpVideo>("t", 6);
  right->bad = {1};
  third->bad = {3};
  third->missing = {{4, 2}};
  FramePairing pairing = pair_frames({left.get(), right.get(), third.get()}, 0, std::nullopt);
  std::vector<std::unique_ptr<FrameSource>> more;
  more.push_back(std::move(third));
  SeveralCameras cameras(
      std::make_unique<TwoCameraPairs>(std::move(left), std::move(right), std::move(pairing)),
      std::move(more));
  EXPECT_EQ(cameras.describe(2), "l 2, r 2, t 2");
  EXPECT_THAT(cameras.identities(), ElementsAre("video l", "video r", "video t"));
  std::vector<std::string> outcomes;
  std::vector<std::string> remarks;
  FramePair pair;
  for (bool goes_on = true; goes_on;) {
    try {
      goes_on = cameras.fetch(pair);
      if (goes_on) {
        cameras.decode(pair);
        outcomes.push_back(std::to_string(value_of(pair.left)) + " " +
                           std::to_string(value_of(pair.right)) + " " +
                           std::to_string(value_of(pair.more.at(0))));
        remarks.insert(remarks.end(), pair.remarks.begin(), pair.remarks.end());
      }
    } catch (const Error& error) {
      outcomes.push_back(std::to_string(pair.index) + ": " + error.what());
    }
  }
  EXPECT_THAT(outcomes,
              ElementsAre("0 0 0", "1: r 1 is bad", "2 2 2", "3: t 3 is bad", "4 4 4", "5 5 5"));
  EXPECT_THAT(remarks,
              ElementsAre("t 4 comes late",
                          "0 frames are missing in the left video but 2 in that of camera 3 before "
                          "pair 4: from here on the images may not be of the same moment"));
}

/// What is held is given again, its problem too.
TEST(StreamedPairs, BadPairsAreBadAgain) {
  auto made = std::make_unique<MadeUpPairs>(4);
  made->bad_to_fetch = {1};
  StreamedPairs pairs(std::move(made), 3);
  const auto outcome = [&](int index) {
    FramePair pair;
    pairs.skip_to(index);
    const std::string error = error_of([&] { pairs.fetch(pair); });
    return error + "|" + std::to_string(pair.index);
  };
  for (const bool again : {false, true}) {
    EXPECT_EQ(outcome(0), "|0") << again;
    EXPECT_EQ(outcome(1), "the stream is damaged|1") << again;
    EXPECT_EQ(outcome(2), "|2") << again;
  }
  pairs.forget_start();
  EXPECT_EQ(outcome(1), "the stream is damaged|1");
  EXPECT_EQ(outcome(2), "|2");
  EXPECT_EQ(outcome(3), "|3");
}

TEST(PackedPairs, ABadFrameIsOneBadPair) {
  auto video = std::make_unique<MadeUpVideo>("v", 4);
  video->bad = {1};
  video->missing = {{3, 1}};
  PackedPairs pairs(std::move(video), {});
  EXPECT_THAT(outcomes_of(pairs), ElementsAre("0 0", "1: v 1 is bad", "2 2", "3 3"));
  pairs.skip_to(2);
  EXPECT_THAT(remarks_of(pairs), ElementsAre(testing::Pair(3, ElementsAre("v 3 comes late"))));
}

TEST(MovingCameraPairs, ABadFrameSpoilsTheTwoPairsThatItIsIn) {
  auto video = std::make_unique<MadeUpVideo>("v", 7);
  video->bad = {2, 6};
  const auto pairs = make_moving_camera_pairs(std::move(video), {.step = 2});
  EXPECT_THAT(outcomes_of(*pairs),
              ElementsAre("0: v 2 is bad", "1 3", "2: v 2 is bad", "3 5", "4: v 6 is bad"));
  pairs->skip_to(1);
  EXPECT_THAT(outcomes_of(*pairs), ElementsAre("1 3", "2: v 2 is bad", "3 5", "4: v 6 is bad"));
}

TEST(MovingCameraPairs, EndsWhereTheVideoEnds) {
  auto video = std::make_unique<MadeUpVideo>("v", 7);
  video->true_count = 5;
  const auto pairs = make_moving_camera_pairs(std::move(video), {.step = -3});
  EXPECT_EQ(pairs->pair_count(), 4);
  EXPECT_THAT(outcomes_of(*pairs), ElementsAre("3 0", "4 1"));
}

TEST(MovingCameraPairs, FramesMissingBetweenTheTwoAreRemarked) {
  auto video = std::make_unique<MadeUpVideo>("v", 8);
  video->missing = {{3, 1}, {4, 2}};
  const auto pairs = make_moving_camera_pairs(std::move(video), {.step = 2});
  const std::map<int, std::vector<std::string>> remarks = remarks_of(*pairs);
  EXPECT_THAT(remarks, testing::SizeIs(3));
  EXPECT_THAT(remarks.at(1), ElementsAre("1 frame is missing between v 1 and v 3"));
  EXPECT_THAT(remarks.at(2), ElementsAre("3 frames are missing between v 2 and v 4"));
  EXPECT_THAT(remarks.at(3), ElementsAre("2 frames are missing between v 3 and v 5"));
}

TEST(MovingCameraPairs, AnOddNumberOfMissingPicturesExchangesTheSides) {
  auto video = std::make_unique<MadeUpVideo>("v", 10);
  video->missing = {{2, 2}, {6, 1}};
  const auto pairs = make_moving_camera_pairs(std::move(video), {.distance = 2});
  const std::map<int, std::vector<std::string>> remarks = remarks_of(*pairs);
  ASSERT_THAT(remarks, testing::SizeIs(1));
  EXPECT_THAT(remarks.at(3), ElementsAre("1 picture is missing before v 7: from here on left and "
                                         "right may be exchanged"));
}

TEST(MovingCameraPairs, EveryFrameIsDecodedOnce) {
  auto video = std::make_unique<MadeUpVideo>("v", 30);
  const MadeUpVideo& counted = *video;
  const auto pairs = make_moving_camera_pairs(std::move(video), {.step = 4});
  FramePair pair;
  ASSERT_TRUE(pairs->fetch(pair));
  EXPECT_EQ(counted.fetched, 5);
  pairs->skip_to(3);  // frames 3 and 4 are kept
  ASSERT_TRUE(pairs->fetch(pair));
  EXPECT_EQ(counted.fetched, 8);
  EXPECT_EQ(outcomes_of(*pairs).size(), 22U);
  EXPECT_EQ(counted.fetched, 30);
}

TEST(TurnsOfPictures, TwoSuccessiveOnesAreAPair) {
  for (const bool right_first : {false, true}) {
    auto video = std::make_unique<MadeUpVideo>("v", 9);
    const MadeUpVideo& counted = *video;
    const auto pairs =
        make_moving_camera_pairs(std::move(video), {.step = right_first ? -1 : 1, .distance = 2});
    const std::vector<std::string> all = right_first
                                             ? std::vector<std::string>{"1 0", "3 2", "5 4", "7 6"}
                                             : std::vector<std::string>{"0 1", "2 3", "4 5", "6 7"};
    EXPECT_EQ(pairs->pair_count(), 4);
    EXPECT_EQ(outcomes_of(*pairs), all);
    EXPECT_EQ(counted.fetched, 8);
    EXPECT_THAT(pairs->remarks(), ElementsAre(HasSubstr("v 8 has no partner")));
    EXPECT_TRUE(pairs->pairing().is_whole());
    for (int first = 3; first >= 0; --first) {
      pairs->skip_to(first);
      EXPECT_EQ(outcomes_of(*pairs), std::vector(all.begin() + first, all.end()));
    }
    EXPECT_EQ(pairs->sound().first_frame, 0);
    EXPECT_EQ(pairs->index_of(3), 3);
  }
}

TEST(TurnsOfPictures, AMissingPictureIsRemarked) {
  auto video = std::make_unique<MadeUpVideo>("v", 10);
  video->bad = {5};
  video->missing = {{3, 1}, {6, 2}, {8, 3}};
  MadeUpVideo& changed = *video;
  const auto pairs =
      make_moving_camera_pairs(std::move(video), SuccessiveFrames{.step = 1, .distance = 2});
  EXPECT_THAT(outcomes_of(*pairs), ElementsAre("0 1", "2 3", "2: v 5 is bad", "6 7", "8 9"));
  changed.bad.clear();
  pairs->skip_to(0);
  const std::map<int, std::vector<std::string>> remarks = remarks_of(*pairs);
  EXPECT_THAT(remarks, testing::SizeIs(2));
  EXPECT_THAT(remarks.at(1),
              ElementsAre("1 frame is missing between v 2 and v 3",
                          HasSubstr("1 picture is missing before v 3: from here on left and")));
  EXPECT_THAT(remarks.at(4), ElementsAre(HasSubstr("3 pictures are missing before v 9")));
}

}  // namespace vantage::pairing_test
