#include "engine/refinement/speckles.h"

#include "tests/engine/engine_test.h"

namespace vantage::speckles_test {

/// A map of one or two components and which of its pixels are matched.
struct Case {
  DisparityMap map;
  DisparityMap map_y;  ///< may be empty
  Mask unmatched;

  [[nodiscard]] bool connects(int x, int y, int other_x, int other_y) const {
    const auto is_near = [&](const DisparityMap& component) {
      return component.empty() ||
             std::abs(component.at(x, y) - component.at(other_x, other_y)) <= 1;
    };
    return unmatched.at(other_x, other_y) == 0 && is_near(map) && is_near(map_y);
  }

  /// The size of each matched pixel's region, by flooding; 0 elsewhere.
  [[nodiscard]] Image<float> region_sizes() const {
    Image<float> sizes(map.width(), map.height());
    sizes.fill(0);
    std::vector<std::pair<int, int>> region;
    const auto visit = [&](int x, int y) {
      if (sizes.at(x, y) == 0) {
        sizes.at(x, y) = -1;
        region.emplace_back(x, y);
      }
    };
    for (const auto [first_x, first_y] : positions_of(map)) {
      region.clear();
      if (unmatched.at(first_x, first_y) == 0) {
        visit(first_x, first_y);
      }
      for (std::size_t i = 0; i < region.size(); ++i) {
        const auto [x, y] = region[i];
        for (const auto& [step_x, step_y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
          const int to_x = x + step_x;
          const int to_y = y + step_y;
          if (to_x >= 0 && to_x < map.width() && to_y >= 0 && to_y < map.height() &&
              connects(x, y, to_x, to_y)) {
            visit(to_x, to_y);
          }
        }
      }
      for (const auto& [x, y] : region) {
        sizes.at(x, y) = static_cast<float>(region.size());
      }
    }
    return sizes;
  }
};

/// Of 100 pixels `holes` are unmatched, half of them unknown; disparities have so many levels, of
/// which neighbours, but no others, are one surface.
Case random_case(std::mt19937& random, int width, int height, unsigned holes, unsigned levels,
                 bool is_two_dimensional) {
  Case made{DisparityMap(width, height), DisparityMap(), Mask(width, height)};
  if (is_two_dimensional) {
    made.map_y.resize(width, height);
  }
  for (const auto [x, y] : positions_of(width, height)) {
    made.unmatched.at(x, y) = random() % 100 < holes ? 255 : 0;
    const bool is_known = made.unmatched.at(x, y) == 0 || random() % 2 == 0;
    for (DisparityMap* component : {&made.map, &made.map_y}) {
      if (!component->empty()) {
        component->at(x, y) = is_known ? 0.75F * static_cast<float>(random() % levels)
                                       : std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
  return made;
}

void expect_marked(Case& made, int min, SpeckleWork& work) {
  const Image<float> sizes = made.region_sizes();
  mark_speckles(made.map.view(), made.map_y.view(), min, work, made.unmatched);
  for (const auto [x, y] : positions_of(made.map)) {
    const bool is_kept = sizes.at(x, y) > 0 && sizes.at(x, y) >= static_cast<float>(min);
    ASSERT_EQ(made.unmatched.at(x, y), is_kept ? 0 : 255)
        << made.map.width() << "x" << made.map.height() << ", least " << min << ", at " << x << ", "
        << y;
  }
}

TEST(Speckles, AreTheRegionsBelowTheLimit) {
  std::mt19937 random(1);
  SpeckleWork work;  // of one case after the other
  for (const auto& [width, height] : {std::pair{1, 1},
                                      {1, 9},
                                      {9, 1},
                                      {2, 3},
                                      {40, 31},
                                      {63, 6},
                                      {64, 9},
                                      {65, 8},
                                      {128, 5},
                                      {129, 7},
                                      {200, 23},
                                      {17, 13}}) {
    for (const int min : {0, 1, 2, 3, 7, 30, 100, 10000}) {
      for (const auto& [holes, levels] : {std::pair{0U, 4U}, {3U, 3U}, {20U, 4U}, {60U, 2U}}) {
        for (const bool is_two_dimensional : {false, true}) {
          Case made = random_case(random, width, height, holes, levels, is_two_dimensional);
          expect_marked(made, min, work);
          ASSERT_FALSE(HasFatalFailure());
        }
      }
    }
  }
}

// Parts of a region that are found to be one only at its end.
TEST(Speckles, ACombIsOneRegion) {
  constexpr int kWidth = 131;
  constexpr int kHeight = 20;
  SpeckleWork work;
  for (const bool has_back : {false, true}) {
    Case comb{DisparityMap(kWidth, kHeight), DisparityMap(), Mask(kWidth, kHeight)};
    comb.map.fill(3);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      comb.unmatched.at(x, y) = x % 2 == 0 || (has_back && y == kHeight - 1) ? 0 : 255;
    }
    expect_marked(comb, kHeight + 1, work);
    EXPECT_EQ(comb.unmatched.at(0, 0), has_back ? 0 : 255);
  }
}

}  // namespace vantage::speckles_test
