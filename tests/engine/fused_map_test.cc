#include "engine/scene_graph/fused_map.h"

#include "tests/engine/engine_test.h"

namespace vantage::fused_map_test {

struct Opinion {
  float disparity_px;
  bool is_guess = false;
  double edge_length = 1;
  bool is_own = true;
};

float fused(const std::vector<Opinion>& opinions, double length = 1) {
  std::vector<DisparityMap> maps;
  std::vector<Mask> masks;
  std::vector<MapOfEdge> edges;
  maps.reserve(opinions.size());
  masks.reserve(opinions.size());
  for (const Opinion& opinion : opinions) {
    maps.emplace_back(1, 1).fill(opinion.disparity_px);
    masks.emplace_back(1, 1).fill(opinion.is_guess ? 255 : 0);
    edges.push_back({.disparity_px = maps.back().view(),
                     .is_unmatched = masks.back().view(),
                     .edge_length = opinion.edge_length,
                     .is_own = opinion.is_own});
  }
  DisparityMap result(1, 1);
  fuse_maps(edges, length, 1.0, result.view(), execution());
  return result.at(0, 0);
}

TEST(FusedMap, OneMapStaysAsItIs) {
  EXPECT_EQ(fused({{7.3F}}), 7.3F);
  EXPECT_EQ(fused({{7.3F, true}}), 7.3F);
  EXPECT_TRUE(std::isnan(fused({{kUnknown}})));
}

TEST(FusedMap, CountsDisparitiesForTheWantedLength) {
  EXPECT_EQ(fused({{6, false, 4}}, 2), 3);
  EXPECT_EQ(fused({{-6, false, 2}, {-9, false, 3}}, 1), -3);
}

TEST(FusedMap, TheLargestGroupThatAgreesDecides) {
  EXPECT_EQ(fused({{4}, {5}}), 4.5F);
  EXPECT_EQ(fused({{4}, {20}, {5}}), 4.5F);
  EXPECT_EQ(fused({{30}, {29.5F}, {5}}), 29.75F);
  EXPECT_EQ(fused({{20}, {5}}), 5);  // farther
  EXPECT_EQ(fused({{1}, {2}, {3}}), 2);
}

TEST(FusedMap, OwnEdgesGoBeforeOthersAndMatchesBeforeGuesses) {
  EXPECT_EQ(fused({{9}, {5, false, 1, false}}), 9);
  EXPECT_EQ(fused({{9, true}, {5, false, 1, false}}), 5);
  EXPECT_EQ(fused({{9, true}, {5, true, 1, false}}), 9);
  EXPECT_EQ(fused({{9, true}, {8, true}}), 8);
  EXPECT_EQ(fused({{kUnknown, true}, {5, true, 1, false}}), 5);
  EXPECT_EQ(fused({{9, true}, {12}}), 12);
}

TEST(FusedMap, EqualForAnyThreadsAndOrder) {
  std::mt19937 random(3);
  const int width = 67;
  const int height = 41;
  std::vector<DisparityMap> maps;
  std::vector<Mask> masks;
  std::vector<MapOfEdge> edges;
  for (int k = 0; k < 4; ++k) {
    DisparityMap& map = maps.emplace_back(width, height);
    Mask& mask = masks.emplace_back(width, height);
    for (const auto [x, y] : positions_of(width, height)) {
      map.at(x, y) = static_cast<float>(random() % 64) / 8;
      mask.at(x, y) = random() % 4 == 0 ? 255 : 0;
    }
    edges.push_back({.disparity_px = map.view(),
                     .is_unmatched = mask.view(),
                     .edge_length = 1.0 + k % 2,
                     .is_own = k < 3});
  }
  const auto fuse = [&](int threads) {
    Execution execution({.threads = threads, .band_height_px = 7});
    DisparityMap result(width, height);
    fuse_maps(edges, 1, 1, result.view(), execution);
    std::vector<float> values;
    for (int y = 0; y < height; ++y) {
      values.insert(values.end(), result.row(y), result.row(y) + width);
    }
    return values;
  };
  const std::vector<float> expected = fuse(1);
  EXPECT_EQ(fuse(3), expected);
  std::swap(edges[0], edges[2]);
  EXPECT_EQ(fuse(2), expected);
}

}  // namespace vantage::fused_map_test
