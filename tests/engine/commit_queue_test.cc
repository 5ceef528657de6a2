#include "engine/sequence/journal/commit_queue.h"

#include "tests/engine/engine_test.h"

namespace vantage::commit_queue_test {

namespace fs = std::filesystem;

class CommitQueueTest : public testing::Test {
 protected:
  static constexpr int kSide = 32;

  [[nodiscard]] fs::path path(const std::string& name) const { return fs::path(folder_ / name); }

  /// Of one frame with one file.
  [[nodiscard]] Delivery delivery(int frame) const {
    const std::string name = std::to_string(frame);
    Delivery made{
        .files = {}, .videos = {}, .records = {}, .frame = frame, .frames = 1, .cells = 2};
    made.files.add(path(name), std::vector<std::uint8_t>(10));
    made.records.emplace_back(FrameRecord{.frame = frame, .files = {{name, {10, 0}}}});
    return made;
  }
  [[nodiscard]] std::unique_ptr<VideoWriter> video(const std::string& name) const {
    auto writer = std::make_unique<VideoWriter>(path(name), kSide, kSide, VideoEncoding());
    Photograph picture{Image<std::uint8_t>(kSide, kSide)};
    std::get<Image<std::uint8_t>>(picture.pixels).fill(9);
    writer->write(picture);
    writer->end();
    return writer;
  }
  [[nodiscard]] std::vector<int> journalled() const {
    std::vector<int> frames;
    for (const JournalRecord& record : RunJournal::read_records(path("journal")).records) {
      frames.push_back(std::get<FrameRecord>(record).frame);
    }
    return frames;
  }
  [[nodiscard]] bool exists(const std::string& name) const { return fs::exists(path(name)); }

  TemporaryFolder folder_;
  RunJournal journal_{path("journal"), {}, JournalOpening::kNew, "all"};
  int frames_told_ = 0;
};

TEST_F(CommitQueueTest, WhatIsDeliveredHasItsNameAndIsRecorded) {
  constexpr int kFrames = 40;
  double cells = 0;
  CommitQueue queue(journal_, [&](int frames, double computed) {
    frames_told_ += frames;
    cells += computed;
    EXPECT_EQ(journalled().size(), static_cast<std::size_t>(frames_told_));
    EXPECT_TRUE(exists(std::to_string(frames_told_ - 1)));
  });
  for (int frame = 0; frame < kFrames; ++frame) {
    queue.push(delivery(frame));
  }
  queue.finish();
  EXPECT_EQ(frames_told_, kFrames);
  EXPECT_EQ(cells, 2.0 * kFrames);
  EXPECT_EQ(journalled().back(), kFrames - 1);
}

TEST_F(CommitQueueTest, VideosAreThereBeforeTheJournalTellsOfThem) {
  CommitQueue queue(journal_, [&](int, double) {
    EXPECT_TRUE(exists("a.mp4") && exists("b.mp4"));
    ++frames_told_;
  });
  Delivery with_videos = delivery(0);
  with_videos.videos.push_back(video("a.mp4"));
  with_videos.videos.push_back(video("b.mp4"));
  EXPECT_FALSE(exists("a.mp4"));
  with_videos.folder = path(".");
  with_videos.segment = SegmentRecord{{0, 1}, {{"a.mp4", {}}, {"b.mp4", {}}}};
  queue.push(std::move(with_videos));
  queue.finish();
  const auto records = RunJournal::read_records(path("journal")).records;
  for (const FileRecord& file : std::get<SegmentRecord>(records.back()).files) {
    EXPECT_EQ(file.content, file_content(path(file.name)));
    EXPECT_GT(file.content.bytes, 500U);
  }
  EXPECT_EQ(frames_told_, 1);
  EXPECT_EQ(VideoReader(path("b.mp4")).frame_count(), 1);
}

TEST_F(CommitQueueTest, NothingBehindAFailureIsDelivered) {
  for (const bool fails_at_video : {false, true}) {
    const int first = fails_at_video ? 10 : 0;
    const std::string error = error_of([&] {
      CommitQueue queue(journal_, [](int, double) {});
      queue.push(delivery(first));
      Delivery bad = delivery(first + 1);
      if (fails_at_video) {
        bad.videos.push_back(video("taken.mp4"));
        fs::create_directory(path("taken.mp4"));
      } else {
        fs::create_directory(path(std::to_string(first + 1)));
      }
      queue.push(std::move(bad));
      queue.push(delivery(first + 2));
      queue.finish();
    });
    EXPECT_THAT(error, HasSubstr("frame " + std::to_string(first + 1) + ": cannot write "));
    EXPECT_FALSE(exists(std::to_string(first + 2)));
  }
  EXPECT_THAT(journalled(), ElementsAre(0, 10));
  for (const auto& entry : fs::directory_iterator(path("."))) {
    EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path();
  }
}

TEST_F(CommitQueueTest, WhatWasPushedIsDeliveredWhenTheQueueGoes) {
  {
    CommitQueue(journal_, [](int, double) {}).push(delivery(3));
  }
  EXPECT_THAT(journalled(), ElementsAre(3));
}

}  // namespace vantage::commit_queue_test
