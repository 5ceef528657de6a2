#include "engine/scene_graph/scene_layout.h"

#include "tests/engine/engine_test.h"

namespace vantage::scene_layout_test {

SceneLayout layout_of(const std::vector<ScenePosition>& positions) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    names.push_back(std::string(1, static_cast<char>('a' + i % 26)) + ".png");
  }
  return {positions, names};
}

std::vector<ScenePosition> grid(const std::vector<double>& columns,
                                const std::vector<double>& rows) {
  std::vector<ScenePosition> positions;
  for (const double y : rows) {
    for (const double x : columns) {
      positions.push_back({x, y});
    }
  }
  return positions;
}

ScenePosition weighted_mean(const SceneLayout& layout, const ScenePlace& place) {
  ScenePosition mean;
  for (std::size_t k = 0; k < 3; ++k) {
    const ScenePosition at = layout.positions()[static_cast<std::size_t>(place.vertices[k])];
    mean.x += place.weights[k] * at.x;
    mean.y += place.weights[k] * at.y;
  }
  return mean;
}

TEST(SceneLayout, ARowHasEdgesFromNeighbourToNeighbour) {
  // Not in the order of the row.
  const SceneLayout layout = layout_of({{5, 2}, {-1, 2}, {0.5, 2}});
  EXPECT_THAT(layout.edges(),
              ElementsAre(SceneEdge{1, 2, false, 1.5}, SceneEdge{2, 0, false, 4.5}));
  EXPECT_THAT(layout.triangles(), IsEmpty());
  EXPECT_EQ(layout.unit_length(), 1.5);

  const ScenePlace place = layout.locate({1.4, 2});
  EXPECT_EQ(place.count, 2);
  EXPECT_THAT(place.vertices, ElementsAre(2, 0, 0));
  EXPECT_NEAR(place.weights[0], 0.8, 1e-12);
  EXPECT_NEAR(place.weights[1], 0.2, 1e-12);
  EXPECT_FALSE(place.is_outside);
  EXPECT_EQ(layout.locate({5, 2}).weights[1], 1);
}

TEST(SceneLayout, OutsideTheNearestEdgeDecides) {
  const SceneLayout layout = layout_of({{0, 0}, {1, 0}, {3, 0}});
  const ScenePlace right = layout.locate({4, 0});
  EXPECT_TRUE(right.is_outside);
  EXPECT_THAT(right.vertices, ElementsAre(1, 2, 0));
  EXPECT_NEAR(right.weights[0], 1.0 / 4, 1e-12);  // (3.14)
  const ScenePlace above = layout.locate({0.5, -0.01});
  EXPECT_TRUE(above.is_outside);
  EXPECT_THAT(above.vertices, ElementsAre(0, 1, 0));
  EXPECT_FALSE(layout.locate({0.5, 1e-7}).is_outside);
}

TEST(SceneLayout, AColumnHasVerticalEdges) {
  const SceneLayout layout = layout_of({{3, 10}, {3, 0}});
  EXPECT_THAT(layout.edges(), ElementsAre(SceneEdge{1, 0, true, 10}));
  EXPECT_THAT(layout.triangles(), IsEmpty());
}

// Every place inside lies in a triangle whose weights tell it, in whatever order cameras are named.
TEST(SceneLayout, TrianglesCoverAGrid) {
  std::vector<ScenePosition> positions = grid({-2, 0, 1, 4}, {0, 0.5, 3});
  std::mt19937 random(5);
  for (int trial = 0; trial < 10; ++trial) {
    std::shuffle(positions.begin(), positions.end(), random);
    const SceneLayout layout = layout_of(positions);
    EXPECT_EQ(layout.edges().size(), 17U);
    EXPECT_EQ(layout.triangles().size(), 12U);
    std::uniform_real_distribution<double> x(-2, 4);
    std::uniform_real_distribution<double> y(0, 3);
    for (int i = 0; i < 200; ++i) {
      const ScenePosition position{x(random), y(random)};
      const ScenePlace place = layout.locate(position);
      ASSERT_TRUE(place.is_triangle());
      ASSERT_FALSE(place.is_outside);
      const ScenePosition mean = weighted_mean(layout, place);
      ASSERT_NEAR(mean.x, position.x, 1e-9);
      ASSERT_NEAR(mean.y, position.y, 1e-9);
    }
    for (const ScenePosition corner : positions) {
      const ScenePlace place = layout.locate(corner);
      EXPECT_TRUE(place.is_triangle());
      EXPECT_EQ(*std::max_element(place.weights.begin(), place.weights.end()), 1);
    }
    EXPECT_TRUE(layout.locate({4.01, 1}).is_outside);
  }
}

TEST(SceneLayout, MissingImagesOfAGridLeaveNoGap) {
  std::vector<ScenePosition> positions = grid({0, 1, 2}, {0, 1, 2});
  positions.erase(positions.begin() + 4);  // the one in the middle
  const SceneLayout layout = layout_of(positions);
  EXPECT_EQ(layout.edges().size(), 10U);  // two of them across the gap
  EXPECT_EQ(layout.triangles().size(), 6U);
  EXPECT_TRUE(layout.locate({1.1, 0.95}).is_triangle());
}

TEST(SceneLayout, PlacesNeedNotBeExact) {
  const SceneLayout layout = layout_of({{0, 0}, {10, 0.009}, {20, 0.001}});
  EXPECT_EQ(layout.edges().size(), 2U);
  EXPECT_THAT(layout.triangles(), IsEmpty());
}

TEST(SceneLayout, VerticesWithoutARowAreJoinedObliquely) {
  // A square with one in its middle: five on a die.
  const SceneLayout die = layout_of({{0, 0}, {2, 0}, {1, 1.5}, {0, 3}, {2, 3}});
  const double length = std::hypot(1, 1.5);
  EXPECT_THAT(die.edges(),
              ElementsAre(SceneEdge{0, 1, false, 2}, SceneEdge{0, 2, true, length, 2 / 3.0},
                          SceneEdge{0, 3, true, 3}, SceneEdge{1, 2, true, length, -2 / 3.0},
                          SceneEdge{1, 4, true, 3}, SceneEdge{2, 3, true, length, -2 / 3.0},
                          SceneEdge{2, 4, true, length, 2 / 3.0}, SceneEdge{3, 4, false, 2}));
  EXPECT_EQ(die.unit_length(), length);
  EXPECT_EQ(die.triangles().size(), 4U);
  EXPECT_NEAR(die.edges()[1].length_along(), 1.5, 1e-12);

  // Beside a row; what is far from its nearest neighbour is joined to others as far away.
  const SceneLayout beside = layout_of({{0, 0}, {1, 0}, {2.5, 0.2}});
  EXPECT_THAT(beside.edges(), ElementsAre(SceneEdge{0, 1, false, 1},
                                          SceneEdge{0, 2, false, std::hypot(2.5, 0.2), 0.08},
                                          SceneEdge{1, 2, false, std::hypot(1.5, 0.2), 0.2 / 1.5}));
  // From the left or above to the right or below, in whatever order they are named.
  EXPECT_THAT(layout_of({{3, 1}, {1, 0}}).edges(),
              ElementsAre(SceneEdge{1, 0, false, std::sqrt(5), 0.5}));
  EXPECT_THAT(layout_of({{3, -4}, {2, 0}}).edges(),
              ElementsAre(SceneEdge{0, 1, true, std::sqrt(17), -0.25}));
}

TEST(SceneLayout, AnObliqueLineIsJoinedFromEndToEnd) {
  const SceneLayout line = layout_of({{4, 2}, {0, 0}, {7, 3.5}, {2, 1}, {9, 4.5}});
  EXPECT_THAT(line.triangles(), IsEmpty());
  ASSERT_EQ(line.edges().size(), 4U);
  const ScenePlace place = line.locate({5, 2.5});
  EXPECT_THAT(place.vertices, ElementsAre(0, 2, 0));
  EXPECT_NEAR(place.weights[1], 1 / 3.0, 1e-12);
  EXPECT_FALSE(place.is_outside);
}

// Cameras anywhere: every vertex has a neighbour, and edges are not much longer than they must be.
TEST(SceneLayout, ScatteredCamerasAreAllJoined) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> anywhere(0, 10);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<ScenePosition> positions;
    for (int i = 0; i < 4 + 3 * trial; ++i) {
      positions.push_back({anywhere(random), anywhere(random)});
    }
    positions.push_back({5000, 3});  // a long way off
    const SceneLayout layout = layout_of(positions);
    std::vector<double> nearest(positions.size(), 1e9);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (std::size_t j = 0; j < positions.size(); ++j) {
        const double away =
            std::hypot(positions[i].x - positions[j].x, positions[i].y - positions[j].y);
        nearest[i] = i == j ? nearest[i] : std::min(nearest[i], away);
      }
    }
    std::vector<double> shortest(positions.size(), 1e9);
    for (const SceneEdge& edge : layout.edges()) {
      const auto first = static_cast<std::size_t>(edge.first);
      const auto second = static_cast<std::size_t>(edge.second);
      if (edge.slope != 0) {
        EXPECT_LE(edge.length, 2 * std::max(nearest[first], nearest[second]) * (1 + 1e-12));
      }
      EXPECT_LE(std::abs(edge.slope), 1);
      shortest[first] = std::min(shortest[first], edge.length);
      shortest[second] = std::min(shortest[second], edge.length);
    }
    for (std::size_t i = 0; i < positions.size(); ++i) {
      EXPECT_LE(shortest[i], 2 * nearest[i]) << trial << " " << i;
    }
  }
}

TEST(SceneLayout, RefusesWhatItCannotJoin) {
  EXPECT_THAT(error_of([] { layout_of({{0, 0}}); }), HasSubstr("1 images, expected 2 to 4096"));
  EXPECT_THAT(error_of([] {
                layout_of({{0, 0}, {1, 0}, {0, 0}});
              }),
              AllOf(HasSubstr("c.png at 0,0"), HasSubstr("same position as a.png")));
  EXPECT_THAT(error_of([] {
                layout_of({{0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0}});
              }),
              HasSubstr("expected finite numbers"));
}

}  // namespace vantage::scene_layout_test
