#include "engine/matching/levels/candidate_blocks.h"

#include "tests/engine/engine_test.h"

namespace vantage::candidate_blocks_test {

using kernels::CandidateGeometry;
using scheduler::Extent;

Image<std::int32_t> random_winners(Extent extent, int candidates, unsigned seed) {
  std::mt19937 random(seed);
  Image<std::int32_t> winners((extent.columns + 1) / 2, (extent.rows + 1) / 2);
  for (const auto [x, y] : positions_of(winners)) {
    // Neighbours are mostly alike.
    winners.at(x, y) = random() % 3 == 0 || x == 0
                           ? static_cast<int>(random() % static_cast<unsigned>(candidates))
                           : winners.at(x - 1, y);
  }
  return winners;
}

/// Block numbers of the tile that pixel (x, y) lies in, pixel by pixel from the definition.
std::vector<std::uint16_t> plain_blocks(const Image<std::int32_t>& winners, int candidates, int max,
                                        int x, int y) {
  std::map<int, int> votes;
  for (const auto [u, v] : positions_of(winners)) {
    const bool is_near =
        u >= x / 8 * 4 - 1 && u <= x / 8 * 4 + 4 && v >= y / 8 * 4 - 1 && v <= y / 8 * 4 + 4;
    if (!is_near) {
      continue;
    }
    std::map<int, bool> touched;
    for (int candidate = winners.at(u, v) - 2; candidate <= winners.at(u, v) + 2; ++candidate) {
      if (candidate >= 0 && candidate < candidates) {
        touched[candidate / 16] = true;
      }
    }
    for (const auto& block : touched) {
      ++votes[block.first];
    }
  }
  std::vector<std::pair<int, int>> order;  // most votes first
  for (const auto& [block, count] : votes) {
    order.emplace_back(-count, block);
  }
  std::ranges::sort(order);
  std::vector<std::uint16_t> blocks;
  for (const auto& [count, block] : order) {
    if (static_cast<int>(blocks.size()) < max) {
      blocks.push_back(static_cast<std::uint16_t>(block));
    }
  }
  std::ranges::sort(blocks);
  return blocks;
}

TEST(CandidateBlocks, AreThoseWithTheMostVotes) {
  unsigned seed = 0;
  for (const Extent extent :
       {Extent{1, 1}, Extent{7, 2}, Extent{8, 8}, Extent{9, 17}, Extent{37, 29}, Extent{64, 3}}) {
    for (const int candidates : {1, 16, 17, 40, 130, 300}) {
      for (const int max : {1, 3, 8}) {
        const auto winners = random_winners(extent, candidates, ++seed);
        CandidateBlocks blocks;
        blocks.resize(extent, candidates, max);
        blocks.choose(winners.view(), std::nullopt, execution());
        EXPECT_EQ(blocks.lanes(), 16 * std::min(max, (candidates + 15) / 16));
        double cells = 0;
        for (const auto [x, y] : positions_of(extent.columns, extent.rows)) {
          const BlockList list = blocks.at(x, y);
          const auto expected = plain_blocks(winners, candidates, max, x, y);
          ASSERT_TRUE(std::ranges::equal(list, expected))
              << extent.columns << "x" << extent.rows << ", " << candidates << " candidates, at "
              << x << ", " << y;
          int count = 0;
          for (int lane = 0; lane < 16 * static_cast<int>(list.size()); ++lane) {
            count += candidate_of(list, lane) < candidates ? 1 : 0;
          }
          ASSERT_EQ(blocks.count(list), count);
          cells += count;
        }
        EXPECT_EQ(blocks.cells(), cells);
      }
    }
  }
}

TEST(CandidateBlocks, SmoothTilesHaveSmallSteps) {
  using enum CandidateBlocks::SmoothTiles;
  const Extent extent{96, 48};
  for (const int step : {2, 3}) {
    for (const bool is_down : {false, true}) {
      Image<std::int32_t> winners(extent.columns / 2, extent.rows / 2);
      for (const auto [x, y] : positions_of(winners)) {
        // A slope of 2, and one step in the third of 12 columns or 6 rows of tiles.
        const int at = is_down ? y : x;
        winners.at(x, y) = 2 * at + (at > 9 ? step - 2 : 0);
      }
      CandidateBlocks blocks;
      blocks.resize(extent, 130, 2);
      blocks.choose(winners.view(), std::nullopt, execution(), kLeftOut);
      for (const auto [tile_x, tile_y] : positions_of(12, 6)) {
        SCOPED_TRACE(testing::Message() << step << ": " << tile_x << ", " << tile_y);
        const int tile = is_down ? tile_y : tile_x;
        const bool is_rough = step == 3 && tile == 2;
        EXPECT_EQ(blocks.smooth().at(tile_x, tile_y), !is_rough);
        // Tiles beside rough ones along the row are made, and all around them have blocks.
        const int made = is_down ? 0 : 1;
        const auto run = blocks.run_at(8 * tile_x, 8 * tile_y, extent.columns);
        EXPECT_EQ(run.is_wanted, step == 3 && std::abs(tile - 2) <= made);
        EXPECT_EQ(run.blocks.empty(), step == 2 || std::abs(tile - 2) > made + 1);
      }
    }
  }
}

TEST(CandidateBlocks, RunsCoverARowAndHaveOneListEach) {
  const Extent extent{217, 9};
  auto winners = random_winners(extent, 60, 3);
  for (int x = 40; x < winners.width(); ++x) {  // a long stretch of equal tiles
    for (int y = 0; y < winners.height(); ++y) {
      winners.at(x, y) = 7;
    }
  }
  CandidateBlocks blocks;
  blocks.resize(extent, 60, 2);
  blocks.choose(winners.view(), std::nullopt, execution());
  int longest = 0;
  for (const int y : {0, 8}) {
    for (const int begin : {0, 3, 8, 100}) {
      for (int x = begin; x < 213;) {
        const CandidateBlocks::Run run = blocks.run_at(x, y, 213);
        ASSERT_EQ(run.columns.begin, x);
        ASSERT_GT(run.columns.end, x);
        ASSERT_LE(run.columns.end, 213);
        ASSERT_LE(run.columns.size(), CandidateBlocks::kMaxRunColumns);
        for (int u = run.columns.begin; u < run.columns.end; ++u) {
          ASSERT_TRUE(std::ranges::equal(blocks.at(u, y), run.blocks));
        }
        longest = std::max(longest, run.columns.size());
        x = run.columns.end;
      }
    }
  }
  EXPECT_EQ(longest, CandidateBlocks::kMaxRunColumns);
}

TEST(CandidateBlocks, LeaveEveryPixelACandidateWithAPartner) {
  unsigned seed = 50;
  for (const int direction : {-1, 1}) {
    for (const int width : {3, 8, 21, 130}) {
      for (const int min : {-70, -5, 0, 1, 13}) {
        const CandidateGeometry geometry{
            .width = width, .disparity_min = min, .count = 100, .direction = direction};
        const Extent extent{width, 9};
        CandidateBlocks blocks;
        blocks.resize(extent, 100, 1);
        blocks.choose(random_winners(extent, 100, ++seed).view(), geometry, execution());
        for (int x = 0; x < width; ++x) {
          const auto inside = geometry.with_partner(x);
          if (inside.empty()) {
            continue;
          }
          const BlockList list = blocks.at(x, 8);
          const bool has_one = std::ranges::any_of(list, [&](int block) {
            return std::max(inside.begin, 16 * block) < std::min(inside.end, 16 * block + 16);
          });
          EXPECT_TRUE(has_one) << "column " << x << " of " << width << ", from " << min;
        }
      }
    }
  }
}

TEST(BlockSegments, EndWhereCandidatesAreLeftOut) {
  const auto ends = [](std::vector<std::uint16_t> blocks) {
    const BlockSegments segments(blocks);
    return std::vector<int>(segments.ends().begin(), segments.ends().end());
  };
  EXPECT_EQ(ends({4}), std::vector<int>{16});
  EXPECT_EQ(ends({0, 1, 2}), std::vector<int>{48});
  EXPECT_EQ(ends({0, 2, 3, 9}), (std::vector<int>{16, 48, 64}));
}

TEST(CopyBlocks, FillsWhatIsMissing) {
  const std::vector<std::uint16_t> from = {1, 2, 5};
  const std::vector<std::uint16_t> to = {0, 2, 5, 7};
  std::vector<std::int16_t> source(48);
  for (std::size_t k = 0; k < source.size(); ++k) {
    source[k] = static_cast<std::int16_t>(candidate_of(from, static_cast<int>(k)));
  }
  std::vector<std::int16_t> target(64);
  copy_blocks(source.data(), from, to, std::int16_t{-1}, target.data());
  for (int lane = 0; lane < 64; ++lane) {
    const int block = lane / 16;
    const bool is_there = block == 1 || block == 2;
    EXPECT_EQ(target[static_cast<std::size_t>(lane)],
              is_there ? static_cast<std::int16_t>(candidate_of(to, lane)) : -1);
  }
}

}  // namespace vantage::candidate_blocks_test
