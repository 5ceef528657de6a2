#include "engine/sequence/work_plan.h"

#include "tests/engine/engine_test.h"

namespace vantage::work_plan_test {

std::vector<FrameRun> plan(const FrameSelection& selection, FrameDependence dependence,
                           const std::set<int>& done) {
  return plan_work(selection, dependence, [&](int frame) { return done.contains(frame); });
}

FrameRun frames(int first, int end, int lead_in = 0) { return {{first, end}, lead_in}; }

TEST(WorkPlan, ShardsCoverEveryFrameOnceInWholeChunks) {
  for (const int count : {0, 1, 49, 50, 51, 97, 350}) {
    for (const int chunk : {1, 7, 50, 1000}) {
      for (const int shards : {1, 2, 3, 7, 60}) {
        int next = 0;
        int min = count + 1;
        int max = 0;
        for (int index = 1; index <= shards; ++index) {
          const FrameSelection selection{.frame_count = count,
                                         .chunk_frames = chunk,
                                         .frames = {},
                                         .shard = Shard{index, shards}};
          const FrameRange own = selection.own();
          if (own.empty()) {
            min = 0;
            continue;
          }
          EXPECT_EQ(own.first, next);
          EXPECT_EQ(own.first % chunk, 0);
          EXPECT_TRUE(own.end % chunk == 0 || own.end == count);
          next = own.end;
          const int chunks = (own.count() + chunk - 1) / chunk;
          min = std::min(min, chunks);
          max = std::max(max, chunks);
        }
        EXPECT_EQ(next, count) << chunk << " " << shards;
        EXPECT_LE(max - min, count == 0 ? count + 1 : 1);
      }
    }
  }
}

TEST(WorkPlan, ShardsOfSelectedFrames) {
  FrameSelection selection{
      .frame_count = 100, .chunk_frames = 10, .frames = FrameRange{15, 47}, .shard = {}};
  EXPECT_EQ(selection.own(), (FrameRange{15, 47}));
  selection.shard = Shard{1, 2};
  EXPECT_EQ(selection.own(), (FrameRange{15, 30}));
  selection.shard = Shard{2, 2};
  EXPECT_EQ(selection.own(), (FrameRange{30, 47}));
  selection.frames = FrameRange{95, 1000};
  selection.shard.reset();
  EXPECT_EQ(selection.own(), (FrameRange{95, 100}));
  selection.frames = FrameRange{100, 1000};
  EXPECT_TRUE(selection.own().empty());
}

TEST(WorkPlan, FramesOnTheirOwnAreRedoneOneByOne) {
  const FrameSelection selection{.frame_count = 9, .chunk_frames = 4, .frames = {}, .shard = {}};
  EXPECT_THAT(plan(selection, {}, {}), ElementsAre(frames(0, 4), frames(4, 8), frames(8, 9)));
  EXPECT_THAT(plan(selection, {}, {0, 1, 2, 5, 8}),
              ElementsAre(frames(3, 4), frames(4, 5), frames(6, 8)));
  EXPECT_THAT(plan(selection, {}, {0, 1, 2, 3, 4, 5, 6, 7, 8}), IsEmpty());
}

TEST(WorkPlan, LeadInReachesBackWithinTheChunk) {
  const FrameSelection selection{.frame_count = 9, .chunk_frames = 4, .frames = {}, .shard = {}};
  EXPECT_THAT(plan(selection, {.on_past = true}, {0, 1, 4, 6, 8}),
              ElementsAre(frames(2, 4, 2), frames(5, 6, 1), frames(7, 8, 3)));
}

TEST(WorkPlan, LeadInReachesBeforeTheSelection) {
  const FrameSelection selection{
      .frame_count = 9, .chunk_frames = 4, .frames = FrameRange{6, 9}, .shard = {}};
  EXPECT_THAT(plan(selection, {.on_past = true}, {}), ElementsAre(frames(6, 8, 2), frames(8, 9)));
}

TEST(WorkPlan, WholeChunksAreRedoneWhole) {
  const FrameSelection selection{
      .frame_count = 11, .chunk_frames = 4, .frames = FrameRange{2, 11}, .shard = {}};
  EXPECT_THAT(plan(selection, {.whole_chunks = true}, {2, 3, 4, 5, 6, 8}),
              ElementsAre(frames(4, 8), frames(8, 11)));
  EXPECT_THAT(plan(selection, {.on_past = true, .whole_chunks = true}, {3}),
              ElementsAre(frames(2, 4, 2), frames(4, 8), frames(8, 11)));
}

TEST(WorkPlan, ChunksNearTheLargestNumber) {
  const FrameSelection selection{
      .frame_count = 2147483647, .chunk_frames = 100000, .frames = {}, .shard = Shard{3, 3}};
  EXPECT_EQ(selection.own().end, 2147483647);
  EXPECT_EQ(selection.chunk_of(2147483646).end, 2147483647);
}

}  // namespace vantage::work_plan_test
