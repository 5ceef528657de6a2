#include "engine/image/tile_mask.h"

#include "tests/engine/engine_test.h"

namespace vantage::tile_mask_test {

TileMask random_mask(int width, int height, int side_px, std::mt19937& random) {
  TileMask mask(width, height, false, side_px);
  for (const auto [column, row] : positions_of(mask.columns(), mask.rows())) {
    mask.set(column, row, random() % 3 != 0);
  }
  return mask;
}

TEST(TileMask, RegionsCoverTheTilesOnce) {
  std::mt19937 random(1);
  for (const scheduler::Extent extent : {scheduler::Extent{1, 1}, {40, 23}, {33, 70}}) {
    for (const int side_px : {4, 16}) {
      const TileMask mask = random_mask(extent.columns, extent.rows, side_px, random);
      std::vector<int> visits(static_cast<std::size_t>(extent.columns * extent.rows));
      for (const scheduler::Region& region : mask.regions()) {
        for (const auto [x, y] : positions_of({region.columns.begin, region.columns.end},
                                              {region.rows.begin, region.rows.end})) {
          ++visits[static_cast<std::size_t>(y * extent.columns + x)];
        }
      }
      for (const auto [x, y] : positions_of(extent.columns, extent.rows)) {
        EXPECT_EQ(visits[static_cast<std::size_t>(y * extent.columns + x)],
                  mask.at(x / side_px, y / side_px) ? 1 : 0);
      }
    }
  }
}

TEST(TileMask, EqualRunsOfRowsBelowEachOtherAreOneRegion) {
  EXPECT_EQ(TileMask(40, 50, true).regions(), (std::vector<scheduler::Region>{{{0, 40}, {0, 50}}}));
}

TEST(TileMask, TilesWithinLargerOnesAreThoseInBoth) {
  std::mt19937 random(3);
  const TileMask mask = random_mask(67, 45, 8, random);
  const TileMask others = random_mask(67, 45, 32, random);
  const TileMask within = mask.within(others);
  for (const auto [x, y] : positions_of(67, 45)) {
    EXPECT_EQ(within.at(x / 8, y / 8), mask.at(x / 8, y / 8) && others.at(x / 32, y / 32));
  }
}

TEST(TileMask, WidenedTilesAreThoseWithPixelsWithinTheMargin) {
  std::mt19937 random(2);
  const int px_per_column = 2;
  const TileMask mask = random_mask(67, 45, 16, random);
  const scheduler::Extent coarse{34, 23};
  for (const int margin : {0, 3}) {
    const TileMask widened = mask.widened(coarse, px_per_column, margin, 4);
    for (const auto [column, row] : positions_of(widened.columns(), widened.rows())) {
      const scheduler::Region tile = widened.pixels(column, row);
      bool is_near = false;
      for (const auto [x, y] : positions_of(67, 45)) {
        is_near = is_near || (mask.at(x / 16, y / 16) && x / 2 >= tile.columns.begin - margin &&
                              x / 2 < tile.columns.end + margin &&
                              y / 2 >= tile.rows.begin - margin && y / 2 < tile.rows.end + margin);
      }
      EXPECT_EQ(widened.at(column, row), is_near) << column << ", " << row;
    }
  }
}

}  // namespace vantage::tile_mask_test
