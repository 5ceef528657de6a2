
#include <cstring>

#include "scheduler/strip_pipeline.h"
#include "tests/scheduler/executor_cases.h"
#include "tests/scheduler/test_chains.h"

namespace vantage::scheduler::strip_regions_test {

class StripRegions : public testing::TestWithParam<ChainCase> {};
INSTANTIATE_TEST_SUITE_P(Chains, StripRegions,
                         testing::Values(kDiffusion, kBoxes, kRunning, kAnchored, kScales,
                                         kSourceEachTime, kSourceAnchored),
                         [](const auto& test) { return test.param.name; });

/// A column, and two blocks beside it that meet at half the height.
std::vector<Region> regions_of(Extent extent) {
  const int column = (extent.columns + 2) / 3;
  const int row = (extent.rows + 1) / 2;
  std::vector<Region> regions = {{{0, column}, {0, extent.rows}}};
  for (const Range rows : {Range{0, row}, {row, extent.rows}}) {
    if (column < extent.columns && !rows.empty()) {
      regions.push_back({{column, extent.columns}, rows});
    }
  }
  return regions;
}

TEST_P(StripRegions, EqualTheirPartsOfTheWholeImage) {
  for (const Extent extent : {Extent{1, 1}, {29, 23}}) {
    TestChain chain(extent, GetParam());
    const std::vector<std::byte> expected = whole_image_result(chain);
    for (const ExecutorCase& executor : executor_cases()) {
      ScratchPool pool;
      {
        constexpr std::size_t kBytes = 1 << 16;
        std::memset(pool.lease(kBytes).data(), 0xFD, kBytes);  // what a stage may not hope for
      }
      chain.sink().forget();
      run_regions(chain.stages(), regions_of(chain.extent()), *executor.make(), pool);
      EXPECT_TRUE(chain.sink().every_cell_came_once());
      EXPECT_EQ(chain.sink().cells(), expected);
    }
  }
}

TEST(StripRegionsTest, NothingElseIsMade) {
  TestChain chain({29, 23}, kBoxes);
  const auto executor = make_executor(ExecutorKind::kSerial, 1);
  ScratchPool pool;
  chain.sink().forget();
  run_regions(chain.stages(), std::vector<Region>{}, *executor, pool);
  for (const std::byte cell : chain.sink().cells()) {
    EXPECT_EQ(cell, std::byte{0});
  }
}

}  // namespace vantage::scheduler::strip_regions_test
