#include "engine/refinement/edge_snapping.h"

#include <opencv2/imgproc.hpp>

#include "engine/execution.h"
#include "engine/refinement/edge_tracing.h"
#include "tests/engine/engine_test.h"

namespace vantage::edge_snapping_test {

Photograph picture(int width, int height, const std::function<int(int x, int y)>& grey_level) {
  Image<std::uint8_t> image(width, height);
  for (const auto [x, y] : positions_of(width, height)) {
    image.at(x, y) = static_cast<std::uint8_t>(grey_level(x, y));
  }
  return {std::move(image)};
}

Mask edges_of(const Photograph& photograph, const ExecutionOptions& options = {.threads = 2}) {
  Execution execution(options);
  EdgeSnappingWork work;
  find_edges(photograph, execution, work);
  return std::move(work.edges);
}

int count(const Mask& mask) {
  int set = 0;
  for (const auto [x, y] : positions_of(mask)) {
    EXPECT_TRUE(mask.at(x, y) == 0 || mask.at(x, y) == 255);
    set += mask.at(x, y) != 0 ? 1 : 0;
  }
  return set;
}

// A step of height h between two pixels, smoothed by the Gaussian and differenced, has a gradient
// of h · (φ(0) + φ(1)) / 2 = 0.32 h in both of them: 10 grey levels per pixel are h = 31.2.
TEST(FindEdges, HighThresholdIsTenGreyLevelsPerPixel) {
  for (const int height : {32, 31}) {
    const auto step = [=](int x, int /*y*/) { return x < 10 ? 100 : 100 + height; };
    const Mask upright = edges_of(picture(21, 15, step));
    const Mask lying = edges_of(picture(15, 21, [&](int x, int y) { return step(y, x); }));
    EXPECT_EQ(count(upright), height == 32 ? 15 : 0);
    EXPECT_EQ(count(lying), height == 32 ? 15 : 0);
    for (int y = 0; y < 15 && height == 32; ++y) {
      EXPECT_TRUE(upright.at(9, y) != 0 || upright.at(10, y) != 0) << y;
      EXPECT_TRUE(lying.at(y, 9) != 0 || lying.at(y, 10) != 0) << y;
    }
  }
}

// 6 grey levels per pixel are a step of 18.7.
TEST(FindEdges, WeakEdgesCountWhereTheyContinueStrongOnes) {
  // A step that fades from one height to the other, one grey level a row.
  const auto step = [](int above, int below) {
    return picture(30, 80,
                   [=](int x, int y) { return x < 15 ? 50 : 50 + std::max(below, above - y); });
  };
  const auto has_edge = [](const Mask& edges, int y) {
    return edges.at(14, y) != 0 || edges.at(15, y) != 0;
  };
  EXPECT_TRUE(has_edge(edges_of(step(60, 20)), 75));
  EXPECT_FALSE(has_edge(edges_of(step(60, 18)), 75));
  EXPECT_TRUE(has_edge(edges_of(step(60, 18)), 5));
  EXPECT_EQ(count(edges_of(step(20, 20))), 0);
}

TEST(FindEdges, DepthAndColourDoNotMatter) {
  const auto grey_level = [](int x, int y) { return x / 9 % 2 * 120 + y / 11 % 2 * 80; };
  const Mask expected = edges_of(picture(53, 41, grey_level));
  EXPECT_GT(count(expected), 100);
  Image<std::uint16_t> deep(53, 41);
  Image<float> real(53, 41);
  Image<std::uint8_t> colour(53, 41, 3);
  for (const auto [x, y] : positions_of(53, 41)) {
    deep.at(x, y) = static_cast<std::uint16_t>(257 * grey_level(x, y));
    real.at(x, y) = static_cast<float>(grey_level(x, y)) / 255;
    for (int channel = 0; channel < 3; ++channel) {
      colour.at(x, y, channel) = static_cast<std::uint8_t>(grey_level(x, y));
    }
  }
  for (const Photograph& same :
       {Photograph{std::move(deep)}, Photograph{std::move(real)}, Photograph{std::move(colour)}}) {
    const Mask edges = edges_of(same);
    for (const auto [x, y] : positions_of(53, 41)) {
      ASSERT_EQ(edges.at(x, y), expected.at(x, y)) << x << ", " << y;
    }
  }
}

TEST(FindEdges, SmallAndConstantImages) {
  const auto step = [](int x, int y) { return x + y < 4 ? 0 : 255; };
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 2}, {3, 9}}) {
    EXPECT_EQ(count(edges_of(picture(width, height, [](int, int) { return 77; }))), 0);
    const Mask edges = edges_of(picture(width, height, step));
    EXPECT_EQ(edges.width(), width);
    EXPECT_EQ(edges.height(), height);
    EXPECT_EQ(count(edges) > 0, width + height > 5) << width << "x" << height;
  }
}

TEST(SnapDiscontinuities, MovesThemToTheEdgesOfTheImageInEveryRow) {
  // The surface ends at column 20, the map three or two columns too late or too early.
  const Photograph image = picture(40, 37, [](int x, int /*y*/) { return x < 20 ? 40 : 200; });
  for (const int threads : {1, 3}) {
    Execution execution({.threads = threads});
    EdgeSnappingWork work;
    find_edges(image, execution, work);
    DisparityMap map(40, 37);
    for (const auto [x, y] : positions_of(map)) {
      map.at(x, y) = x < 20 + y % 6 - 3 ? 9.0F : 3.0F;
    }
    snap_discontinuities(work.edges, 4, execution, map);
    for (const auto [x, y] : positions_of(map)) {
      // Beside the edge pixel, which is one of 19 and 20.
      if (x < 19 || x > 20) {
        ASSERT_EQ(map.at(x, y), x < 20 ? 9.0F : 3.0F) << x << ", " << y;
      }
    }
  }
}

// Gradients of few values have many equal neighbours.
TEST(TraceEdges, AreThoseOfOpenCv) {
  for (const auto& [width, height, spread] :
       {std::array{61, 47, 60}, {64, 33, 16000}, {1, 9, 100}, {9, 1, 100}, {2, 2, 100}}) {
    std::mt19937 random(static_cast<unsigned>(width));
    Image<std::int16_t> gradient_x(width, height);
    Image<std::int16_t> gradient_y(width, height);
    for (const auto [x, y] : positions_of(width, height)) {
      std::uniform_int_distribution<int> value(-spread, spread);
      gradient_x.at(x, y) = static_cast<std::int16_t>(value(random));
      gradient_y.at(x, y) = static_cast<std::int16_t>(value(random));
    }
    const auto wrap = [](Image<std::int16_t>& image) {
      return cv::Mat(image.height(), image.width(), CV_16S, image.row(0),
                     image.view().stride() * sizeof(std::int16_t));
    };
    const EdgeThresholds thresholds{spread / 2, spread};
    cv::Mat expected;
    cv::Canny(wrap(gradient_x), wrap(gradient_y), expected, thresholds.low, thresholds.high, true);
    Execution execution({.threads = 3});
    Mask edges(width, height);
    trace_edges(gradient_x, gradient_y, thresholds, execution, edges);
    for (const auto [x, y] : positions_of(width, height)) {
      ASSERT_EQ(edges.at(x, y), expected.at<std::uint8_t>(y, x)) << x << ", " << y;
    }
  }
}

}  // namespace vantage::edge_snapping_test
