#include "scheduler/whole_image_pipeline.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "tests/scheduler/test_chains.h"

// The oracle of the strip pipeline against plain loops over arrays.

namespace vantage::scheduler::whole_image_pipeline_test {

using Plane = std::vector<float>;  // [y][x][lane]

std::size_t cell_index(Extent extent, int x, int y) {
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(extent.columns) +
          static_cast<std::size_t>(x)) *
         kCellLanes;
}

Plane hashed_plane(Extent extent) {
  Plane plane(cell_index(extent, 0, extent.rows));
  for (int y = 0; y < extent.rows; ++y) {
    for (int x = 0; x < extent.columns; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        plane[cell_index(extent, x, y) + static_cast<std::size_t>(i)] = hashed_float(x, y, i);
      }
    }
  }
  return plane;
}

template <typename Value>
std::vector<Value> whole_image_values(const ChainCase& chain_case, Extent extent) {
  TestChain chain(extent, chain_case);
  const std::vector<std::byte> cells = whole_image_result(chain);
  std::vector<Value> values(cells.size() / sizeof(Value));
  std::memcpy(values.data(), cells.data(), cells.size());
  return values;
}

TEST(WholeImagePipeline, DiffusesLikePlainLoops) {
  for (const Extent extent : kSizes) {
    Plane plane = hashed_plane(extent);
    for (int iteration = 0; iteration < 10; ++iteration) {
      Plane next = plane;
      for (int y = 0; y < extent.rows; ++y) {
        for (int x = 0; x < extent.columns; ++x) {
          for (std::size_t i = 0; i < kCellLanes; ++i) {
            const float centre = plane[cell_index(extent, x, y) + i];
            float sum = 0;
            for (const auto& [dx, dy] : {std::pair{0, -1}, {-1, 0}, {1, 0}, {0, 1}}) {
              if (x + dx >= 0 && x + dx < extent.columns && y + dy >= 0 && y + dy < extent.rows) {
                sum += plane[cell_index(extent, x + dx, y + dy) + i] - centre;
              }
            }
            next[cell_index(extent, x, y) + i] = centre + 0.15F * sum;
          }
        }
      }
      plane = next;
    }
    EXPECT_TRUE(whole_image_values<float>(kDiffusion, extent) == plane)
        << extent.columns << "x" << extent.rows;
  }
}

TEST(WholeImagePipeline, SumsRowsLikePlainLoops) {
  for (const Extent extent : kSizes) {
    std::vector<std::int32_t> sums(cell_index(extent, 0, extent.rows));
    for (int y = 0; y < extent.rows; ++y) {
      for (int x = 0; x < extent.columns; ++x) {
        for (int i = 0; i < kCellLanes; ++i) {
          for (int row = std::max(0, y - 2); row <= std::min(extent.rows - 1, y + 2); ++row) {
            sums[cell_index(extent, x, y) + static_cast<std::size_t>(i)] += hashed_int(x, row, i);
          }
        }
      }
    }
    EXPECT_EQ(whole_image_values<std::int32_t>(kRunning, extent), sums);
  }
}

TEST(WholeImagePipeline, SumsBoxesLikePlainLoops) {
  for (const Extent extent : kSizes) {
    Plane plane = hashed_plane(extent);
    for (const int radius : {1, 1, 1, 2}) {
      Plane next(plane.size(), 0.0F);
      for (int y = 0; y < extent.rows; ++y) {
        for (int x = 0; x < extent.columns; ++x) {
          for (int row = std::max(0, y - radius); row <= std::min(extent.rows - 1, y + radius);
               ++row) {
            for (int column = std::max(0, x - radius);
                 column <= std::min(extent.columns - 1, x + radius); ++column) {
              for (std::size_t i = 0; i < kCellLanes; ++i) {
                next[cell_index(extent, x, y) + i] += plane[cell_index(extent, column, row) + i];
              }
            }
          }
        }
      }
      plane = next;
    }
    EXPECT_TRUE(whole_image_values<float>(kBoxes, extent) == plane);
  }
}

TEST(WholeImagePipeline, MixesTheSourceLikePlainLoops) {
  for (const Extent extent : kSizes) {
    std::vector<std::uint32_t> source(cell_index(extent, 0, extent.rows));
    for (int y = 0; y < extent.rows; ++y) {
      for (int x = 0; x < extent.columns; ++x) {
        for (int i = 0; i < kCellLanes; ++i) {
          for (int row = std::max(0, y - 2); row <= std::min(extent.rows - 1, y + 2); ++row) {
            source[cell_index(extent, x, y) + static_cast<std::size_t>(i)] +=
                static_cast<std::uint32_t>(hashed_int(x, row, i));
          }
        }
      }
    }
    std::vector<std::uint32_t> plane = source;
    for (int iteration = 0; iteration < 10; ++iteration) {
      std::vector<std::uint32_t> next = source;
      for (int y = 0; y < extent.rows; ++y) {
        for (int x = 0; x < extent.columns; ++x) {
          for (std::size_t i = 0; i < kCellLanes; ++i) {
            std::uint32_t& sum = next[cell_index(extent, x, y) + i];
            sum *= 101U;
            for (int dy = -1; dy <= 1; ++dy) {
              for (int dx = -1; dx <= 1; ++dx) {
                if (x + dx >= 0 && x + dx < extent.columns && y + dy >= 0 && y + dy < extent.rows) {
                  sum += Mixture::factor(dx, dy) * plane[cell_index(extent, x + dx, y + dy) + i];
                }
              }
            }
          }
        }
      }
      plane = next;
    }
    EXPECT_TRUE(whole_image_values<std::uint32_t>(kSourceEachTime, extent) == plane);
  }
}

}  // namespace vantage::scheduler::whole_image_pipeline_test
