// Which images of two cameras belong together, by their names; films by the times of their frames.

#include "engine/sequence/pairs/frame_pairing.h"

#include <cmath>

#include "engine/io/video/image_sequence.h"
#include "tests/engine/engine_test.h"

namespace vantage::frame_pairing_test {

using Names = std::vector<std::string>;
using Indices = std::vector<std::pair<int, int>>;

std::unique_ptr<FrameSource> images(const std::string& folder, const Names& names) {
  return std::make_unique<ListedImages>(
      folder, folder, std::vector<std::filesystem::path>(names.begin(), names.end()));
}

Indices indices_of(const FramePairing& pairing) {
  Indices pairs;
  for (int pair = 0; pair < pairing.count; ++pair) {
    pairs.emplace_back(pairing.frame(0, pair), pairing.frame(1, pair));
  }
  return pairs;
}

FramePairing pairing_of(const Names& left, const Names& right, int offset = 0,
                        std::optional<PairBy> by = {}) {
  const auto l = images("l", left);
  const auto r = images("r", right);
  return pair_frames({l.get(), r.get()}, offset, by);
}

Indices pairs_of(const Names& left, const Names& right, int offset = 0,
                 std::optional<PairBy> by = {}) {
  return indices_of(pairing_of(left, right, offset, by));
}

TEST(FramePairing, ADroppedFrameOnEachSide) {
  const FramePairing pairing = pairing_of({"0.png", "1.png", "3.png", "4.png", "5.png"},
                                          {"0.png", "2.png", "3.png", "4.png", "5.png"});
  EXPECT_EQ(indices_of(pairing), (Indices{{0, 0}, {2, 2}, {3, 3}, {4, 4}}));
  EXPECT_EQ(pairing.found.by, PairBy::kName);
  EXPECT_THAT(pairing.found.left_out, ElementsAre(1, 1));
  EXPECT_THAT(pairing.remarks, ElementsAre("2 frames are left out without a partner (1 of the "
                                           "left, 1 of the right): l/1.png, r/2.png"));
}

TEST(FramePairing, WhatNamesShare) {
  const Indices first_and_last = {{0, 0}, {2, 1}};
  for (const auto& [left, right] : std::vector<std::pair<Names, Names>>{
           {{"left_0001.png", "left_0002.png", "left_0003.png"},
            {"right_0001.png", "right_0003.png"}},
           {{"frame_1_L.png", "frame_2_L.png", "frame_3_L.png"},
            {"frame_001_R.jpg", "frame_003_R.jpg"}},
           {{"cam0_1.png", "cam0_2.png", "cam0_3.png"}, {"cam1_1.png", "cam1_3.png"}},
           {{"s1_cam0_7.png", "s2_cam0_5.png", "s2_cam0_7.png"},
            {"s1_cam1_7.png", "s2_cam1_7.png", "s2_cam1_9.png"}},
           {{"gate_L.png", "old_bridge_L.png", "tower_L.png"}, {"gate_R.png", "tower_R.png"}},
           {{"aachen_01_19_leftImg8bit.png", "aachen_01_20_leftImg8bit.png",
             "ulm_01_19_leftImg8bit.png"},
            {"aachen_01_19_rightImg8bit.png", "ulm_01_19_rightImg8bit.png"}},
           {{"00_10.png", "00_11.png", "01_10.png"}, {"00_10.png", "01_10.png"}},
           {{"imgL9.png", "imgL10.png", "imgL11.png"}, {"9R.png", "11R.png"}},
           {{"shot1.0099.png", "shot1.0100.png", "shot1.0101.png"},
            {"shot1.99.png", "shot1.101.png"}},
           {{"20260101_235959_9.png", "20260102_000000_1.png", "20260102_000000_5.png"},
            {"20260101_235959_9.png", "20260102_000000_5.png"}}}) {
    EXPECT_EQ(pairs_of(left, right), first_and_last) << left[0];
  }
  // A camera's own file beside them changes nothing.
  EXPECT_EQ(pairs_of({"left_1.png", "left_2.png", "target.png"}, {"right_1.png", "right_2.png"}),
            (Indices{{0, 0}, {1, 1}}));
  EXPECT_EQ(pairs_of({"7.png"}, {"6.png", "7.png"}), (Indices{{0, 1}}));
  EXPECT_EQ(pairs_of({"im0.png"}, {"im1.png"}), (Indices{{0, 0}})) << "one each is a pair";
}

TEST(FramePairing, TimeStampsWithinHalfAFrame) {
  const Indices but_the_second = {{0, 0}, {2, 1}, {3, 2}};
  for (const auto& [left, right] : std::vector<std::pair<Names, Names>>{
           // EuRoC, 20 Hz; the right camera 2 ms late, one frame equal by chance
           {{"1403636579763555584.png", "1403636579813555456.png", "1403636579863555584.png",
             "1403636579913555456.png"},
            {"1403636579765555584.png", "1403636579863555584.png", "1403636579915555456.png"}},
           // seconds, as TUM and ROS write them
           {{"1305031102.175304.png", "1305031102.211214.png", "1305031102.243211.png",
             "1305031102.275326.png"},
            {"1305031102.170407.png", "1305031102.246738.png", "1305031102.272886.png"}},
           // nanoseconds without zeros in front
           {{"left_1403636579.950000000.png", "left_1403636580.0.png",
             "left_1403636580.50000000.png", "left_1403636580.100000000.png"},
            {"right_1403636579.960000000.png", "right_1403636580.60000000.png",
             "right_1403636580.110000000.png"}},
           // milliseconds
           {{"1403636579763.png", "1403636579796.png", "1403636579830.png", "1403636579863.png"},
            {"1403636579760.png", "1403636579829.png", "1403636579870.png"}}}) {
    EXPECT_EQ(pairs_of(left, right), but_the_second) << left[0];
  }
  EXPECT_EQ(pairs_of({"1305031102.0000000.png", "1305031102.1000000.png"},
                     {"1305031102.0490000.png", "1305031102.1510000.png"}),
            (Indices{{0, 0}}))
      << "half a frame is 0.05 s";
  // Any numbers, if the user says that they are times.
  EXPECT_EQ(pairs_of({"33.png", "66.png", "100.png"}, {"34.png", "101.png"}, 0, PairBy::kTime),
            (Indices{{0, 0}, {2, 1}}));
}

TEST(FramePairing, OffsetsCountFromTheFirstFrames) {
  const Names left = {"0.png", "1.png", "3.png", "4.png"};
  EXPECT_EQ(pairs_of(left, {"0.png", "1.png", "2.png", "4.png", "5.png"}, 1),
            (Indices{{0, 1}, {1, 2}, {2, 3}, {3, 4}}));
  EXPECT_EQ(pairs_of(left, {"12.png", "13.png", "16.png", "17.png"}, 1),
            (Indices{{0, 1}, {2, 2}, {3, 3}}));
  EXPECT_EQ(pairs_of({"a.png", "b.png", "c.png"}, {"a.png", "b.png", "c.png"}, -1),
            (Indices{{1, 0}, {2, 1}}));
}

TEST(FramePairing, WhereNamesTellNothing) {
  const FramePairing pairing = pairing_of({"im0.png", "im2.png"}, {"im1.png", "im3.png"});
  EXPECT_EQ(indices_of(pairing), (Indices{{0, 0}, {1, 1}}));
  EXPECT_EQ(pairing.found.by, PairBy::kOrder);
  EXPECT_THAT(pairing.remarks,
              testing::Contains("the names share nothing: frames are paired in their order"));
  EXPECT_THAT(
      error_of([] {
        pairs_of({"im0.png", "im2.png"}, {"im1.png", "im3.png", "im5.png"});
      }),
      testing::AllOf(HasSubstr("the names share nothing and the numbers of frames differ: 2 "
                               "frames (l/im0.png to l/im2.png) on the left, 3 frames"),
                     HasSubstr("or `pair-by` order")));
  // As many, but not the same are missing.
  EXPECT_THAT(
      error_of([] {
        pairs_of({"0.png", "2.png", "6.png", "8.png"}, {"1.png", "3.png", "5.png", "9.png"});
      }),
      HasSubstr("other numbers are missing on each side"));
  EXPECT_EQ(pairs_of({"0.png", "2.png"}, {"1.png", "3.png", "5.png"}, 0, PairBy::kOrder).size(),
            2U);
  EXPECT_THAT(error_of([] {
                pairs_of({"a.png", "b.png"}, {"c.png", "d.png"}, 0, PairBy::kName);
              }),
              HasSubstr("the names share nothing"));
}

TEST(FramePairing, ThirdCamerasArePairedWithTheLeftOne) {
  const auto left = images("l", {"0.png", "1.png", "2.png", "3.png"});
  const auto right = images("r", {"0.png", "1.png", "3.png"});
  const auto third = images("t", {"1.png", "2.png", "3.png"});
  const FramePairing pairing = pair_frames({left.get(), right.get(), third.get()}, 0, {});
  EXPECT_EQ(indices_of(pairing), (Indices{{1, 1}, {3, 2}}));
  EXPECT_EQ(pairing.frame(2, 0), 0);
  EXPECT_EQ(pairing.frame(2, 1), 2);
  EXPECT_THAT(pairing.found.left_out, ElementsAre(2, 1, 1));
  const auto error_with = [&](const Names& names, int offset, std::optional<PairBy> by) {
    const auto other = images("t", names);
    return error_of([&] { pair_frames({left.get(), right.get(), other.get()}, offset, by); });
  };
  EXPECT_THAT(error_with({"2.png"}, 0, PairBy::kName),
              HasSubstr("no frame has a partner in the sequences of all cameras"));
  EXPECT_THAT(error_with({"0.png"}, -2, PairBy::kOrder),
              HasSubstr("no pair has a partner in the sequence of camera 3, which has 1 frames"));
  const FramePairing in_order =
      pair_frames({left.get(), right.get(), third.get()}, 0, PairBy::kOrder);
  EXPECT_EQ(in_order.count, 3);
  const auto two = images("t", {"5.png", "6.png"});
  const FramePairing fewer = pair_frames({left.get(), right.get(), two.get()}, 0, PairBy::kOrder);
  EXPECT_EQ(fewer.count, 2);
  EXPECT_THAT(fewer.remarks,
              testing::Contains(HasSubstr("camera 3 has frames for 2 pairs, but the first two "
                                          "cameras have 3: the last 1 has no partner")));
}

/// A film of which only the times matter.
class Film : public FrameSource {
 public:
  /// `times`: of its frames, in 1000ths of a second; those of its rate where even.
  Film(FilmStart start, FrameRate rate, int count, std::vector<std::int64_t> times = {})
      : start_(start), rate_(rate), count_(count), times_(std::move(times)) {}

  bool fetch(FetchedFrame&) override { return false; }
  void skip_to(int) override {}
  [[nodiscard]] int frame_count() const override { return count_; }
  [[nodiscard]] std::string describe(int index) const override {
    return "film frame " + std::to_string(index);
  }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override { return rate_; }
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override {
    return times_.empty() ? std::nullopt : std::optional(FrameTimes{times_, 1, 1000, rate_});
  }
  [[nodiscard]] std::optional<FilmStart> start() const override { return start_; }
  [[nodiscard]] std::filesystem::path video_file() const override { return "film"; }
  [[nodiscard]] std::string identity() const override { return "film"; }

 private:
  FilmStart start_;
  FrameRate rate_;
  int count_;
  std::vector<std::int64_t> times_;
};

TEST(FramePairing, FilmsByTheTimeOfTheirFrames) {
  const Film left({0.0}, {25, 1}, 6);
  const Film late({0.12}, {25, 1}, 6);
  FramePairing pairing = pair_frames({&left, &late}, 0, {});
  EXPECT_EQ(indices_of(pairing), (Indices{{3, 0}, {4, 1}, {5, 2}}));
  EXPECT_EQ(pairing.found.by, PairBy::kTime);
  EXPECT_THAT(pairing.remarks,
              ElementsAre("the right film starts 0.120 s after the left one and has 25 frames a "
                          "second, the left one 25: frames are paired by the time at which they "
                          "are shown",
                          HasSubstr("6 frames are left out without a partner (3 of the left, 3 of "
                                    "the right): film frame 0, film frame 1, film frame 2, film")));
  EXPECT_EQ(indices_of(pair_frames({&left, &late}, 0, PairBy::kOrder)).size(), 6U);
  EXPECT_EQ(indices_of(pair_frames({&left, &late}, 1, {})).front(), (std::pair{0, 1}));
  // Clocks of MPEG streams and times from 0 cannot be compared.
  const Film stream({1.4, true}, {25, 1}, 6);
  EXPECT_EQ(indices_of(pair_frames({&left, &stream}, 0, {})).size(), 6U);
  // One frame is missing.
  const Film gap({0.0}, {25, 1}, 5, {0, 40, 120, 160, 200, 240});
  pairing = pair_frames({&left, &gap}, 0, {});
  EXPECT_EQ(indices_of(pairing), (Indices{{0, 0}, {1, 1}, {3, 2}, {4, 3}, {5, 4}}));
  EXPECT_THAT(pairing.found.left_out, ElementsAre(1, 0));
  EXPECT_THAT(error_of([&] {
                pair_frames({&left, &gap}, 0, PairBy::kName);
              }),
              HasSubstr("frames of films have none"));
  const auto stills = images("l", {"0.png", "1.png"});
  EXPECT_THAT(error_of([&] {
                pair_frames({&left, stills.get()}, 0, PairBy::kTime);
              }),
              HasSubstr("it is not known when each frame is shown"));
  // Another year.
  const Film later({1e8}, {25, 1}, 6);
  EXPECT_THAT(
      pair_frames({&left, &later}, 0, {}).remarks,
      testing::Contains(HasSubstr("the films share no time: frames are paired in their order")));
}

TEST(FramePairing, FilmsOfOtherRates) {
  const Film left({0.0}, {30, 1}, 60);
  const Film right({0.0}, {25, 1}, 50);
  const FramePairing pairing = pair_frames({&left, &right}, 0, {});
  EXPECT_EQ(pairing.count, 50);
  for (const auto& [l, r] : indices_of(pairing)) {
    EXPECT_LE(std::abs(l / 30.0 - r / 25.0), 0.5 / 30 + 1e-6) << l;
  }
  EXPECT_THAT(pairing.remarks.front(), HasSubstr("has 25 frames a second, the left one 30"));
  const Film twice({0.0}, {50, 1}, 100);
  EXPECT_THAT(indices_of(pair_frames({&right, &twice}, 0, {})),
              testing::Contains(std::pair{7, 14}));
}

}  // namespace vantage::frame_pairing_test
