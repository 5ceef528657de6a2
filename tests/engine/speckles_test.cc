#include "engine/refinement/speckles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace vantage {
namespace {

/// Sizes of regions by relaxation: every pixel takes the smallest number of its region until
/// nothing changes.
std::vector<int> region_sizes(const DisparityMap& map, const Mask& unmatched) {
  const int width = map.width();
  const int pixels = width * map.height();
  std::vector<int> label(static_cast<std::size_t>(pixels));
  for (int i = 0; i < pixels; ++i) {
    label[static_cast<std::size_t>(i)] = i;
  }
  const auto joined = [&](int a, int b) {
    return unmatched.at(a % width, a / width) == 0 && unmatched.at(b % width, b / width) == 0 &&
           std::abs(map.at(a % width, a / width) - map.at(b % width, b / width)) <= 1;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < pixels; ++i) {
      for (const int j : {i % width + 1 < width ? i + 1 : i, i + width < pixels ? i + width : i}) {
        int& a = label[static_cast<std::size_t>(i)];
        int& b = label[static_cast<std::size_t>(j)];
        if (a != b && joined(i, j)) {
          a = b = std::min(a, b);
          changed = true;
        }
      }
    }
  }
  std::vector<int> count(static_cast<std::size_t>(pixels), 0);
  for (const int one : label) {
    ++count[static_cast<std::size_t>(one)];
  }
  std::vector<int> sizes;
  for (const int one : label) {
    sizes.push_back(count[static_cast<std::size_t>(one)]);
  }
  return sizes;
}

TEST(Speckles, AreTheRegionsBelowTheLimit) {
  std::mt19937 random(1);
  SpeckleWork work;
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 3}, {17, 13}, {40, 31}}) {
    for (const int least : {0, 1, 2, 3, 7, 30, 10000}) {
      DisparityMap map(width, height);
      Mask unmatched(width, height);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          unmatched.at(x, y) = random() % 5 == 0 ? 255 : 0;
          map.at(x, y) = unmatched.at(x, y) != 0 && random() % 2 == 0
                             ? std::numeric_limits<float>::quiet_NaN()
                             : 0.75F * static_cast<float>(random() % 5);
        }
      }
      const std::vector<int> sizes = region_sizes(map, unmatched);
      const Mask before = unmatched.copy();
      mark_speckles(map.view(), {}, least, work, unmatched);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const bool small = sizes[static_cast<std::size_t>(y * width + x)] < least;
          ASSERT_EQ(unmatched.at(x, y), before.at(x, y) != 0 || small ? 255 : 0)
              << width << "x" << height << ", least " << least << ", at " << x << ", " << y;
        }
      }
    }
  }
}

}  // namespace
}  // namespace vantage
