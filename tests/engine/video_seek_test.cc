// Frames in the middle of a video, without decoding it from its beginning.

#include "engine/io/video/frame_source.h"
#include "engine/io/video/video_io.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/video_test_support.h"
#include "tests/test_sample.h"

namespace vantage::video_seek_test {

constexpr FrameRate kRate{10, 1};
constexpr int kFrames = 24;
constexpr int kGroup = 7;

/// Every frame as read from the beginning.
std::vector<Photograph> all_frames(const std::filesystem::path& path) {
  VideoReader reader(path);
  std::vector<Photograph> frames(1);
  while (reader.read(frames.back())) {
    frames.emplace_back();
  }
  frames.pop_back();
  return frames;
}

TEST(VideoSeek, FramesFromAnyStartOnAreThoseFromTheBeginning) {
  const TemporaryFolder folder;
  put_closed_groups_video(folder / "a.mp4", kFrames, kRate, kGroup);
  remux_video(folder / "a.mp4", folder / "a.mov", "mov", kRate, {},
              [](int frame) { return frame < 10 ? frame : frame + 2; });
  for (const char* video : {"a.mp4", "a.mov"}) {
    SCOPED_TRACE(video);
    const std::vector<Photograph> expected = all_frames(folder / video);
    ASSERT_EQ(static_cast<int>(expected.size()), kFrames);
    VideoReader reader(folder / video);
    Photograph frame;
    for (int last = kFrames - 1; last >= 0; --last) {
      const int start = last / kGroup * kGroup;
      ASSERT_EQ(reader.go_to_start(0, last), start);
      // To the end from the last frame of each group only.
      const bool is_group_end = last + 1 == kFrames || (last + 1) % kGroup == 0;
      for (int i = start; i < (is_group_end ? kFrames : start + 1); ++i) {
        ASSERT_TRUE(reader.read(frame));
        ASSERT_TRUE(same(frame, expected[static_cast<std::size_t>(i)])) << start << " " << i;
      }
      EXPECT_EQ(reader.go_to_start(start + 1, last), std::nullopt);
      if (is_group_end) {
        EXPECT_FALSE(reader.read(frame)) << "nothing happened";
      }
    }
    EXPECT_EQ(reader.go_to_next_start(1), kGroup);
    EXPECT_EQ(reader.go_to_next_start(3 * kGroup), 3 * kGroup);
    EXPECT_EQ(reader.go_to_next_start(3 * kGroup + 1), std::nullopt);
  }
}

/// In open groups frames refer to the group before; an edit list shifts the numbers; without an
/// index of all frames nothing is known.
TEST(VideoSeek, BeginsOnlyWhereNothingBeforeIsNeeded) {
  const TemporaryFolder folder;
  put_open_groups_video(folder / "open.mp4", kFrames, kRate);
  EXPECT_EQ(VideoReader(folder / "open.mp4").go_to_start(1, kFrames - 1), std::nullopt);
  EXPECT_EQ(VideoReader(folder / "open.mp4").go_to_start(0, kFrames - 1), 0);
  put_closed_groups_video(folder / "a.mp4", kFrames, kRate, kGroup);
  remux_video(folder / "a.mp4", folder / "a.mkv", "matroska", kRate);
  EXPECT_EQ(VideoReader(folder / "a.mkv").go_to_start(1, kFrames - 1), std::nullopt);
  remux_video(folder / "a.mp4", folder / "edited.mp4", "mp4", kRate, {},
              [](int frame) { return frame - 3; });
  const std::vector<Photograph> expected = all_frames(folder / "edited.mp4");
  ASSERT_EQ(static_cast<int>(expected.size()), kFrames - 3);
  VideoReader reader(folder / "edited.mp4");
  Photograph frame;
  for (int start = kGroup - 3; start < kFrames - 3; start += kGroup) {
    ASSERT_EQ(reader.go_to_start(1, start + 1), start);
    ASSERT_TRUE(reader.read(frame));
    EXPECT_TRUE(same(frame, expected[static_cast<std::size_t>(start)])) << start;
  }
}

/// What a source gives for a frame: picture, remarks, problem.
struct Outcome {
  FetchedFrame frame;
  std::string problem;
  bool is_end = false;
};

Outcome fetch_from(FrameSource& source) {
  Outcome outcome;
  outcome.problem = error_of([&] { outcome.is_end = !source.fetch(outcome.frame); });
  if (outcome.problem.empty() && !outcome.is_end) {
    outcome.frame.decode();
  }
  return outcome;
}

void expect_same(const Outcome& outcome, const Outcome& expected) {
  EXPECT_EQ(outcome.problem, expected.problem);
  EXPECT_EQ(outcome.is_end, expected.is_end);
  EXPECT_EQ(outcome.frame.remarks, expected.frame.remarks);
  if (expected.problem.empty() && !expected.is_end) {
    EXPECT_TRUE(same(outcome.frame.photograph, expected.frame.photograph));
  }
}

/// After skip_to() from some places, in the `turn`-th call for each frame another one, to anywhere;
/// returns what a source gives that is read from the beginning.
std::vector<Outcome> expect_to_skip_everywhere(const std::filesystem::path& path, int turn) {
  const auto sequential = open_frame_source(path.string());
  std::vector<Outcome> expected;
  for (int i = 0; i < kFrames + 1; ++i) {
    expected.push_back(fetch_from(*sequential));
  }
  const auto source = open_frame_source(path.string());
  constexpr int kFrom[] = {0, 5, kGroup, 2 * kGroup + 1, kFrames};
  for (const auto [k, to] : positions_of(static_cast<int>(std::size(kFrom)), kFrames)) {
    if (k != (to + turn) % 5 && !runs_everything()) {
      continue;
    }
    const int from = kFrom[k];
    SCOPED_TRACE(testing::Message() << path.filename() << " " << from << " to " << to);
    source->skip_to(from);
    expect_same(fetch_from(*source), expected[static_cast<std::size_t>(from)]);
    source->skip_to(to);
    expect_same(fetch_from(*source), expected[static_cast<std::size_t>(to)]);
    expect_same(fetch_from(*source), expected[static_cast<std::size_t>(to) + 1]);
  }
  return expected;
}

TEST(VideoSeek, SkippingGivesTheSameFramesAndRemarks) {
  const TemporaryFolder folder;
  put_closed_groups_video(folder / "a.mp4", kFrames, kRate, kGroup);
  // A frame is missing before a frame to begin with, and in the middle of a group.
  remux_video(folder / "a.mp4", folder / "gaps.mp4", "mp4", kRate, {}, [](int frame) {
    return frame < kGroup ? frame : frame < 2 * kGroup + 3 ? frame + 1 : frame + 3;
  });
  const std::vector<Outcome> outcomes = expect_to_skip_everywhere(folder / "gaps.mp4", 0);
  for (int turn = 1; turn < 5; ++turn) {
    expect_to_skip_everywhere(folder / "gaps.mp4", turn);
  }
  EXPECT_EQ(outcomes[kGroup].frame.frames_missing, 1);
  EXPECT_EQ(outcomes[2 * kGroup + 3].frame.frames_missing, 2);
  put_open_groups_video(folder / "open.mp4", kFrames, kRate);
  for (const int turn : {0, 2}) {
    expect_to_skip_everywhere(folder / "open.mp4", turn);
  }
}

/// A packet is damaged: the frames up to the next group are lost, whoever reads them.
TEST(VideoSeek, DamageEndsWithItsGroup) {
  const TemporaryFolder folder;
  put_closed_groups_video(folder / "a.mp4", kFrames, kRate, kGroup);
  const std::vector<VideoPacket> packets = video_packets(folder / "a.mp4");
  const auto whole = bytes_of(folder / "a.mp4");
  int turn = 0;
  for (const int damaged : {0, 2, kGroup, kGroup + 4, kFrames - 1}) {
    auto bytes = whole;
    std::fill_n(bytes.begin() + packets[static_cast<std::size_t>(damaged)].offset, 4,
                std::uint8_t{0xFF});
    put_bytes(folder / "b.mp4", bytes);
    const std::vector<Outcome> outcomes = expect_to_skip_everywhere(folder / "b.mp4", turn++);
    const int group_end = (damaged / kGroup + 1) * kGroup;
    for (int i = 0; i < kFrames; ++i) {
      const bool may_be_bad = i >= damaged / kGroup * kGroup && i < group_end;
      EXPECT_TRUE(may_be_bad || outcomes[static_cast<std::size_t>(i)].problem.empty())
          << damaged << ": " << outcomes[static_cast<std::size_t>(i)].problem;
    }
    const auto bad = std::ranges::count_if(
        outcomes, [](const Outcome& outcome) { return !outcome.problem.empty(); });
    EXPECT_GE(bad, 1) << damaged;
  }
}

}  // namespace vantage::video_seek_test
