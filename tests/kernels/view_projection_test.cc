#include "kernels/view_projection/view_projection.h"

#include "tests/kernels/projection_cases.h"

namespace vantage::kernels::view_projection_test {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Point {
  double u, v, depth_ratio, nearness;
};

// The definition, without any regard for the form of the warp.
Point plain_point(const ViewProjection& view, double x, double y, double d) {
  double image[3];
  for (int i = 0; i < 3; ++i) {
    image[i] = view.homography[3 * i] * x + view.homography[3 * i + 1] * y +
               view.homography[3 * i + 2] + d * view.parallax[i];
  }
  return {image[0] / image[2], image[1] / image[2], image[2],
          (d - view.infinity_disparity_px) / image[2]};
}

bool near_half(double value) { return std::abs(value - std::floor(value) - 0.5) < 1e-9; }

TEST(ViewProjection, IsTheDefinition) {
  std::mt19937 random(1);
  int after = 0;
  for (const ViewProjection& view : projection_cases()) {
    for (const int width : kAwkwardWidths) {
      const std::vector<float> d = random_disparities(random, width, -3, 20);
      const int first_column = static_cast<int>(random() % 50);
      const int line = static_cast<int>(random() % 40);
      ProjectedValues values(width);
      project_row(view, {d.data(), width, first_column, line}, values.row());
      for (std::size_t i = 0; i < d.size(); ++i) {
        const Point point = plain_point(view, first_column + static_cast<int>(i), line, d[i]);
        if (std::isnan(d[i]) || point.depth_ratio <= 0) {
          after += std::isnan(d[i]) ? 0 : 1;
          ASSERT_TRUE(std::isnan(values.disparity_px[i]));
          ASSERT_EQ(values.nearness[i], -kInfinity);
          continue;
        }
        ASSERT_EQ(values.disparity_px[i], d[i]);
        ASSERT_NEAR(values.nearness[i], point.nearness, 1e-6 * (1 + std::abs(point.nearness)));
        if (!near_half(point.u) && !near_half(point.v)) {
          ASSERT_EQ(values.column[i], std::floor(point.u + 0.5));
          ASSERT_EQ(values.line[i], std::floor(point.v + 0.5));
        }
      }
    }
  }
  EXPECT_GT(after, 100);
}

TEST(ViewProjection, EqualOnEveryInstructionSet) {
  std::mt19937 random(2);
  std::vector<ViewProjection> views = projection_cases();
  views.push_back(translation(16, -16));
  views.push_back(views.back());
  views.back().infinity_disparity_px = 0.75;
  for (const ViewProjection& view : views) {
    for (const int width : kAwkwardWidths) {
      std::vector<float> d = random_disparities(random, width, -20, 60);
      for (const float wild : {kInfinity, -kInfinity, 3e38F, -3e38F, 1e10F}) {
        d[random() % d.size()] = wild;
      }
      ProjectedValues expected(width);
      project_row(view, {d.data(), width, 3, 7}, expected.row());
      for_each_target([&] {
        ProjectedValues values(width);
        project_row(view, {d.data(), width, 3, 7}, values.row());
        ASSERT_TRUE(are_same(values.disparity_px, expected.disparity_px));
        ASSERT_EQ(values.nearness, expected.nearness);
        ASSERT_EQ(values.column, expected.column);
        ASSERT_EQ(values.line, expected.line);
      });
    }
  }
}

}  // namespace vantage::kernels::view_projection_test
