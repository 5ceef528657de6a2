#include "engine/sequence/journal/sequence_join.h"

#include "engine/io/video/video_io.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"

namespace vantage::sequence_join_test {

namespace fs = std::filesystem;

class SequenceJoinTest : public testing::Test {
 protected:
  static constexpr int kFrames = 4;
  static constexpr int kSide = 32;

  SequenceJoinTest() { layout_.make_folders(); }

  /// A segment whose frames are of these grey levels.
  void make_segment(FrameRange frames, const std::vector<std::uint8_t>& greys) {
    VideoWriter writer(layout_.segment(layout_.streams().front(), frames), kSide, kSide, {});
    for (const std::uint8_t grey : greys) {
      Photograph picture{Image<std::uint8_t>(kSide, kSide)};
      std::get<Image<std::uint8_t>>(picture.pixels).fill(grey);
      writer.write(picture);
    }
    writer.finish();
    append(SegmentRecord{frames,
                         {record_of_file(folder_.path(), layout_.segment_names(frames).front())}});
  }
  void append(const JournalRecord& record) { journal_.append({&record, 1}); }
  void join(bool made_segments) {
    join_segments(options_, layout_, identity_, {0, kFrames}, made_segments, journal_);
  }
  [[nodiscard]] fs::path video() const { return layout_.video(layout_.streams().front()); }

  TemporaryFolder folder_;
  SequenceOptions options_ = [] {
    SequenceOptions options;
    options.save = {SequenceOutput::kPreview};
    options.video = options.save;
    return options;
  }();
  SequenceLayout layout_{folder_.path(), options_};
  RunIdentity identity_ = [] {
    RunIdentity identity;
    identity.frame_count = kFrames;
    return identity;
  }();
  RunJournal journal_{layout_.journal_folder(), identity_, JournalOpening::kNew, "all"};
};

/// As after a kill between the repair of a frame and the joining of its segment.
TEST_F(SequenceJoinTest, WhatWasJoinedWithAFrameSkippedIsJoinedAnewWhenThatIsDone) {
  make_segment({0, 2}, {10, 20});
  make_segment({2, 4}, {30, 30});
  for (const int frame : {0, 1, 2}) {
    append(FrameRecord{.frame = frame});
  }
  append(FrameRecord{.frame = 3, .skipped = true});
  join(true);
  const auto with_skipped = bytes_of(video());
  join(false);
  EXPECT_EQ(bytes_of(video()), with_skipped);
  make_segment({2, 4}, {30, 200});
  append(FrameRecord{.frame = 3});
  join(false);
  EXPECT_NE(bytes_of(video()), with_skipped);
  EXPECT_EQ(VideoReader(video()).frame_count(), kFrames);
  EXPECT_FALSE(fs::exists(layout_.journal_folder() / "segments"));
  const auto complete = bytes_of(video());
  join(false);
  join(true);
  EXPECT_EQ(bytes_of(video()), complete);
}

TEST_F(SequenceJoinTest, FramesThatTheInputDoesNotHaveNeedNoSegment) {
  make_segment({0, 2}, {10, 20});
  append(FrameRecord{.frame = 0});
  append(FrameRecord{.frame = 1});
  append(FrameRecord{.frame = 2});
  append(FrameRecord{.frame = 3, .absent = true});
  EXPECT_THAT(error_of([&] { join(true); }), HasSubstr("frame 2 is in no video segment"));
  append(FrameRecord{.frame = 2, .absent = true});
  join(true);
  EXPECT_EQ(VideoReader(video()).frame_count(), 2);
}

/// Frame 0 is shown a second after the start of the file, the others at uneven times after it.
TEST_F(SequenceJoinTest, SoundStartsAtTheTimeOfTheFirstFrame) {
  make_segment({0, kFrames}, {10, 20, 30, 40});
  for (int frame = 0; frame < kFrames; ++frame) {
    append(FrameRecord{.frame = frame});
  }
  Sound sound{16000, std::vector<float>(4 * 16000)};
  constexpr double kBeepSeconds = 1.75;
  for (int i = 0; i < 800; ++i) {
    sound.samples[static_cast<std::size_t>(kBeepSeconds * 16000) + i] = i % 16 < 8 ? 0.5F : -0.5F;
  }
  put_numbered_video(folder_ / "silent.mp4", 4, {1, 1});
  identity_.sound_file = folder_ / "film.mkv";
  remux_video(folder_ / "silent.mp4", identity_.sound_file, "matroska", {1, 1}, sound);
  identity_.sound_rate = options_.frame_rate;
  identity_.frame_times = FrameTimes{{1000, 1100, 1600, 1700, 2900}, 1, 1000, options_.frame_rate};
  join(true);
  const auto joined = VideoReader(video()).frame_times();
  ASSERT_TRUE(joined);
  EXPECT_NEAR(joined->seconds(2), 0.6, 1e-9);
  const Sound heard = read_sound(video());
  const auto loud = std::ranges::find_if(heard.samples, [](float x) { return x > 0.25F; });
  const auto samples = static_cast<double>(loud - heard.samples.begin());
  EXPECT_NEAR(samples / heard.samples_per_second, kBeepSeconds - 1, 0.01);
  EXPECT_NEAR(static_cast<double>(heard.samples.size()) / heard.samples_per_second, 1.9, 0.1);
}

}  // namespace vantage::sequence_join_test
