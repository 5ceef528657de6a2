#include "engine/sequence/frame_iterator.h"

#include "engine/io/maps/map_io.h"
#include "scheduler/interruption.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/made_up_pairs.h"

namespace vantage::frame_iterator_test {

class FrameIteratorTest : public testing::Test {
 protected:
  FrameIteratorTest() {
    options_.match.method = MatchMethod::kSsd;
    options_.match.disparities = {0, 9};
    options_.match.parameters.window_px = 5;
    options_.chunk_frames = 4;
  }

  [[nodiscard]] SequenceRun run_of(PairSource& pairs, int in_flight) const {
    return {.pairs = pairs,
            .selection = {.frame_count = pairs.pair_count(),
                          .chunk_frames = options_.chunk_frames,
                          .frames = std::nullopt,
                          .shard = std::nullopt},
            .frame_size = ImageExtent{37, 23},
            .in_flight = in_flight,
            .keep_going = keep_going_,
            .on_progress = {},
            .stop = nullptr};
  }

  /// Number → map of the frames, until the end or an error, which goes to problem_.
  std::map<int, std::vector<std::uint8_t>> maps(const std::vector<int>& frames,
                                                const ExecutionOptions& where = {.threads = 3},
                                                int in_flight = 3) {
    Execution execution(where);
    FrameIterator iterator(options_, run_of(pairs_, in_flight), frames, execution);
    std::map<int, std::vector<std::uint8_t>> found;
    problem_.clear();
    try {
      while (const auto frame = iterator.next()) {
        encode_disparity("map.pfm", frame->slot->maps.left.disparity_px.view(),
                         found[frame->slot->frame]);
      }
    } catch (const Error& error) {
      problem_ = error.what();
      EXPECT_FALSE(iterator.next());
    }
    skipped_ = iterator.skipped();
    return found;
  }

  static std::vector<int> first(int count) {
    std::vector<int> frames(static_cast<std::size_t>(count));
    std::iota(frames.begin(), frames.end(), 0);
    return frames;
  }

  SequenceOptions options_;
  MadeUpPairs pairs_ = MadeUpPairs(10);
  bool keep_going_ = false;
  std::string problem_;
  std::vector<FrameRemark> skipped_;
};

TEST_F(FrameIteratorTest, FramesDoNotDependOnTheExecution) {
  for (const bool reuses : {false, true}) {
    if (reuses) {  // all of these frames moved
      options_.match.method = MatchMethod::kBayes;
      options_.match.parameters.window_px.reset();
      options_.match.parameters.levels = 2;
    }
    options_.temporal.weight = reuses ? 0 : 1;
    options_.temporal.reuse = reuses ? Reuse::kFrame : Reuse::kNone;
    const auto expected = maps(first(10), {.threads = 1}, 1);
    ASSERT_EQ(expected.size(), 10U);
    for (const scheduler::ExecutorKind kind :
         {scheduler::ExecutorKind::kTbb, scheduler::ExecutorKind::kOpenMp,
          scheduler::ExecutorKind::kSerial}) {
      EXPECT_EQ(maps(first(10), {.threads = 3, .executor = kind}, 4), expected);
    }
    for (const auto& [frame, map] : maps({2, 3, 7})) {
      EXPECT_EQ(map, expected.at(frame)) << frame;
    }
    EXPECT_THAT(maps({}), IsEmpty());
  }
}

TEST_F(FrameIteratorTest, NoMoreFramesAreComputedThanInFlight) {
  std::atomic<int> fetched{0};
  pairs_.after_fetch = [&] { ++fetched; };
  FrameIterator iterator(options_, run_of(pairs_, 3), first(10), execution());
  const auto waits_for = [&](int count) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (fetched < count && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return fetched.load();
  };
  EXPECT_EQ(waits_for(3), 3);
  for (int taken = 1; taken <= 10; ++taken) {
    ASSERT_EQ(iterator.next()->slot->frame, taken - 1);
    EXPECT_LE(fetched, taken + 3);
  }
  EXPECT_FALSE(iterator.next());
}

TEST_F(FrameIteratorTest, BadFramesComeInTheirTurn) {
  pairs_.bad_to_decode = {2};
  pairs_.bad_to_fetch = {6};
  EXPECT_EQ(maps(first(10)).size(), 2U);
  EXPECT_THAT(problem_, HasSubstr("frame 2 (left 2, right 2): left 2: is truncated"));
  keep_going_ = true;
  pairs_.skip_to(0);
  const auto found = maps(first(10));
  EXPECT_EQ(found.size(), 8U);
  EXPECT_THAT(problem_, IsEmpty());
  ASSERT_EQ(skipped_.size(), 2U);
  EXPECT_EQ(skipped_[0].frame, 2);
  EXPECT_THAT(skipped_[1].text, HasSubstr("the stream is damaged"));
  pairs_.ends_at = 4;  // fewer than its header says
  EXPECT_EQ(maps(first(10)).size(), 3U);
}

TEST_F(FrameIteratorTest, LeavingEndsTheWork) {
  options_.match.method = MatchMethod::kDiffusion;
  options_.match.parameters.window_px.reset();
  options_.match.parameters.iterations = 10000;
  FrameIterator iterator(options_, run_of(pairs_, 2), first(10), execution());
  const scheduler::InterruptibleScope scope([] { return true; });
  EXPECT_THROW(iterator.next(), scheduler::Interrupted);
}

}  // namespace vantage::frame_iterator_test
