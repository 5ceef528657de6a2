#include "engine/sequence/sequence_join.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/io/video_io.h"
#include "tests/engine/io_test_support.h"

namespace vantage {
namespace sequence_join_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::error_of;
using testing::HasSubstr;

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

}  // namespace sequence_join_test
}  // namespace vantage
