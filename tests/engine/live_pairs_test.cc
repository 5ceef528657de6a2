// Streams of which the newest pair is taken, and pairs that a caller supplies.
#include "engine/sequence/pairs/live_pairs.h"
#include "engine/sequence/frame_iterator.h"
#include "engine/sequence/latency_meter.h"
#include "engine/sequence/pairs/streamed_pairs.h"
#include "engine/sequence/pairs/supplied_pairs.h"
#include "tests/engine/frame_test_support.h"
#include "tests/engine/made_up_pairs.h"

namespace vantage::live_pairs_test {

using std::chrono::milliseconds;

PairQueue::Pair pair_of(int value) {
  return {plain_photograph(8, 4, value), plain_photograph(8, 4, value + 100)};
}

/// Index and value of the next pair; empty at the end.
std::optional<std::pair<int, int>> next(PairSource& pairs) {
  FramePair pair;
  if (!pairs.fetch(pair)) {
    return std::nullopt;
  }
  pairs.decode(pair);
  EXPECT_EQ(value_of(pair.right), value_of(pair.left) + 100);
  return std::pair(pair.index, value_of(pair.left));
}

void wait_until(const std::function<bool()>& holds) {
  while (!holds()) {
    std::this_thread::sleep_for(milliseconds(1));
  }
}

TEST(LivePairs, TheNewestPairIsTakenAndOthersAreCounted) {
  const auto queue = std::make_shared<PairQueue>(1);
  LivePairs live(std::make_unique<SuppliedPairs>(queue));
  live.forget_start();
  EXPECT_FALSE(live.is_ready(milliseconds(0)));
  for (int value = 0; value < 5; ++value) {
    queue->put(pair_of(value));  // waits for its room only
  }
  wait_until([&] { return live.dropped_pairs() == 4; });
  FramePair pair;
  ASSERT_TRUE(live.fetch(pair));
  EXPECT_EQ(pair.index, 4);
  EXPECT_EQ(pair.details.name, "000004");
  ASSERT_TRUE(pair.arrival.has_value());
  EXPECT_LE(*pair.arrival, std::chrono::steady_clock::now());
  EXPECT_EQ(live.describe(0), "pair 4");  // of the first result
  EXPECT_FALSE(live.is_ready(milliseconds(0)));
  live.skip_to(0);  // the past does not come again
  queue->put(pair_of(5));
  EXPECT_EQ(next(live), std::pair(5, 5));
  queue->put(pair_of(6));
  queue->end();
  EXPECT_EQ(next(live), std::pair(6, 6));
  EXPECT_EQ(next(live), std::nullopt);
  EXPECT_EQ(live.dropped_pairs(), 4);
}

TEST(LivePairs, BadPairsAreNotDropped) {
  auto made = std::make_unique<MadeUpPairs>(10);
  made->bad_to_fetch = {4};
  LivePairs live(std::move(made));
  live.forget_start();
  wait_until([&] { return live.dropped_pairs() == 3; });
  FramePair pair;
  ASSERT_TRUE(live.fetch(pair));
  EXPECT_EQ(pair.index, 3);
  EXPECT_THROW(live.fetch(pair), Error);
  EXPECT_EQ(live.describe(1), "left 4, right 4");
  int fetched = 1;
  while (live.fetch(pair)) {
    ++fetched;
  }
  EXPECT_EQ(pair.index, 9);
  EXPECT_EQ(fetched + live.dropped_pairs(), 9);
}

TEST(LivePairs, AreOfStreamsOnly) {
  PairSourceOptions options;
  options.queue = std::make_shared<PairQueue>(4);
  options.live = true;
  options.masks = {};
  for (int value = 0; value < 3; ++value) {
    options.queue->put(pair_of(10 * value + 1));
  }
  const auto pairs = open_pair_source(options);
  EXPECT_TRUE(pairs->is_stream());
  // The first pair is looked at before the run, and comes again.
  EXPECT_EQ(pairs->repeatable_pairs(), (FrameRange{0, 1}));
  pairs->skip_to(0);
  EXPECT_EQ(next(*pairs), std::pair(0, 1));
  pairs->skip_to(0);
  pairs->forget_start();
  wait_until([&] { return pairs->dropped_pairs() == 2; });
  EXPECT_EQ(next(*pairs), std::pair(2, 21));
  options.queue->close();
  EXPECT_FALSE(options.queue->put(pair_of(1)));
  const TemporaryFolder folder;
  put_images(folder / "left", {1});
  options.queue.reset();
  options.left = folder / "left";
  options.right = folder / "left";
  EXPECT_THROW(open_pair_source(options), UsageError);
}

TEST(SuppliedPairs, GoForward) {
  const auto queue = std::make_shared<PairQueue>(4);
  for (int value = 0; value < 4; ++value) {
    queue->put(pair_of(value));
  }
  queue->end();
  StreamedPairs pairs(std::make_unique<SuppliedPairs>(queue), 1);
  EXPECT_EQ(next(pairs), std::pair(0, 0));
  EXPECT_EQ(next(pairs), std::pair(1, 1));
  pairs.skip_to(0);
  EXPECT_TRUE(pairs.is_ready(milliseconds(0)));
  EXPECT_EQ(next(pairs), std::pair(0, 0));
  pairs.skip_to(3);
  EXPECT_EQ(next(pairs), std::pair(3, 3));
  EXPECT_EQ(next(pairs), std::nullopt);
  pairs.skip_to(1);
  FramePair pair;
  EXPECT_THROW(pairs.fetch(pair), Error);
}

TEST(SuppliedPairs, ResultsComeBeforeFurtherPairs) {
  const auto queue = std::make_shared<PairQueue>(1);
  SuppliedPairs pairs(queue);
  Execution execution({.threads = 1});
  SequenceOptions options;
  options.match.method = MatchMethod::kSsd;
  options.match.disparities = {0, 1};
  options.match.parameters.window_px = 3;
  const SequenceRun run{.pairs = pairs,
                        .selection = {.frame_count = pairs.pair_count(),
                                      .chunk_frames = 10,
                                      .frames = std::nullopt,
                                      .shard = std::nullopt},
                        .frame_size = ImageExtent{8, 4},
                        .in_flight = 3,
                        .on_progress = {},
                        .stop = nullptr};
  FrameIterator frames(options, run, {}, execution);
  for (int value = 0; value < 3; ++value) {
    queue->put(pair_of(value));
    const auto frame = frames.next();  // the only thread does not wait for the next pair
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->slot->frame, value);
    EXPECT_EQ(value_of(*frame->slot->left), value);
  }
  queue->end();
  EXPECT_FALSE(frames.next().has_value());
}

TEST(LatencyMeter, CountsFromArrivalToDelivery) {
  using std::chrono::hours;
  LatencyMeter meter;
  const auto now = std::chrono::steady_clock::now();
  EXPECT_EQ(meter.report().frames, 0);
  for (int age_h = 1; age_h <= 21; ++age_h) {
    meter.leaves(now - hours(age_h));
  }
  meter.leaves(std::nullopt);  // failed
  meter.leaves(now - hours(100));
  meter.delivered(22);  // the last one is on its way
  const LiveReport report = meter.report();
  EXPECT_EQ(report.frames, 21);
  constexpr double kHour_ms = 3.6e6;
  EXPECT_NEAR(report.median_ms / kHour_ms, 11, 0.5);
  EXPECT_NEAR(report.percentile_95_ms / kHour_ms, 20, 0.5);
  EXPECT_NEAR(report.max_ms / kHour_ms, 21, 0.5);
  meter.delivered(1);
  EXPECT_EQ(meter.report().frames, 22);
}

}  // namespace vantage::live_pairs_test
