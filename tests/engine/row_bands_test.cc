#include "engine/synthesis/row_bands.h"

#include <thread>

#include "tests/engine/engine_test.h"

namespace vantage::row_bands_test {

// Rows in any order, from several threads: each is filled when those up to 16 rows away are made,
// and finished when these are filled, once.
TEST(RowBands, StepsFollowTheirNeighbours) {
  for (const int rows : {1, 16, 17, 33, 150}) {
    std::vector<int> order(static_cast<std::size_t>(rows));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    std::vector<std::atomic<int>> step(static_cast<std::size_t>(rows));
    RowBands bands(rows, 24, execution());
    const auto advance = [&](int first, int end, int to) {
      for (int y = std::max(first - 16, 0); y < std::min(end + 16, rows); ++y) {
        EXPECT_GE(step[static_cast<std::size_t>(y)], to - 1) << y;
      }
      for (int y = first; y < end; ++y) {
        std::byte* const row = bands.row(y);
        EXPECT_EQ(row[0], std::byte(y));
        EXPECT_EQ(row[23], std::byte(y));
        EXPECT_EQ(step[static_cast<std::size_t>(y)].exchange(to), to - 1);
      }
    };
    const auto work = [&](std::size_t begin) {
      for (std::size_t k = begin; k < order.size(); k += 3) {
        const int y = order[k];
        std::fill_n(bands.row(y), 24, std::byte(y));
        step[static_cast<std::size_t>(y)] = 1;
        bands.complete(
            y, [&](int first, int end) { advance(first, end, 2); },
            [&](int first, int end) { advance(first, end, 3); });
      }
    };
    std::vector<std::jthread> threads;
    for (const std::size_t begin : {0, 1, 2}) {
      threads.emplace_back(work, begin);
    }
    threads.clear();
    for (const std::atomic<int>& reached : step) {
      EXPECT_EQ(reached, 3);
    }
  }
}

}  // namespace vantage::row_bands_test
