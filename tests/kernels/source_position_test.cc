#include "kernels/source_position/source_position.h"

#include <Eigen/LU>

#include "tests/kernels/projection_cases.h"

namespace vantage::kernels::source_position_test {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

SourceProjection way_back(const ViewProjection& view) {
  SourceProjection back;
  back.infinity_disparity_px = view.infinity_disparity_px;
  back.is_translation = view.is_translation;
  if (view.is_translation) {
    std::copy_n(view.parallax, 3, back.parallax);
    return back;
  }
  const Eigen::Vector3d parallax = Eigen::Vector3d::Map(view.parallax);
  Eigen::Matrix3d far = RowMajor::Map(view.homography);
  far.col(2) += view.infinity_disparity_px * parallax;
  RowMajor::Map(back.homography) = far.inverse();
  Eigen::Vector3d::Map(back.parallax) = far.inverse() * parallax;
  return back;
}

struct Positions {
  std::vector<std::int32_t> column, line;
  std::vector<float> fraction_x, fraction_y, disparity_px, nearness;

  explicit Positions(std::size_t count)
      : column(count),
        line(count),
        fraction_x(count),
        fraction_y(count),
        disparity_px(count),
        nearness(count) {}
  [[nodiscard]] SourcePositions outputs() {
    return {column.data(),     line.data(),         fraction_x.data(),
            fraction_y.data(), disparity_px.data(), nearness.data()};
  }
};

// There and back again: a source position's target is the place in the new view.
TEST(SourcePosition, IsTheWayBack) {
  std::mt19937 random(1);
  int returned = 0;
  for (const ViewProjection& view : projection_cases()) {
    const SourceProjection back = way_back(view);
    for (const int width : kAwkwardWidths) {
      std::vector<float> nearness(width);
      for (float& q : nearness) {
        q = random() % 9 == 0 ? -std::numeric_limits<float>::infinity()
                              : static_cast<float>(random() % 1000) / 100;
      }
      const int line = static_cast<int>(random() % 40);
      Positions found(nearness.size());
      source_positions_row(back,
                           {.nearness = nearness.data(),
                            .count = width,
                            .line = line,
                            .source_width = 1000,
                            .source_height = 800},
                           found.outputs());
      for (std::size_t u = 0; u < nearness.size(); ++u) {
        if (std::isinf(nearness[u])) {
          ASSERT_TRUE(std::isnan(found.nearness[u]) && std::isnan(found.disparity_px[u]));
          ASSERT_EQ(found.column[u], 0);
          continue;
        }
        if (std::isnan(found.nearness[u])) {
          ASSERT_FALSE(view.is_translation);
          continue;
        }
        ASSERT_EQ(found.nearness[u], nearness[u]);
        const double x = found.column[u] + double{found.fraction_x[u]};
        const double y = found.line[u] + double{found.fraction_y[u]};
        if (x <= -1 || y <= -1 || x >= 999.5 || y >= 799.5) {
          continue;
        }
        const ExactTarget target = exact_target(view, x, y, found.disparity_px[u]);
        const double scale = 1 + std::abs(1 / target.depth_ratio);
        ASSERT_NEAR(target.u, static_cast<double>(u), 1e-5 * scale);
        ASSERT_NEAR(target.v, line, 1e-5 * scale);
        ASSERT_NEAR((found.disparity_px[u] - view.infinity_disparity_px) / target.depth_ratio,
                    nearness[u], 1e-5 * scale);
        ++returned;
      }
    }
  }
  EXPECT_GT(returned, 5000);
}

TEST(SourcePosition, EqualOnEveryInstructionSet) {
  std::mt19937 random(2);
  for (const ViewProjection& view : projection_cases()) {
    const SourceProjection back = way_back(view);
    for (const int width : kAwkwardWidths) {
      std::vector<float> nearness(width);
      for (float& q : nearness) {
        q = static_cast<float>(random() % 2000) / 50 - 10;
      }
      for (const float special : {-std::numeric_limits<float>::infinity(), 3e38F, -3e38F,
                                  std::numeric_limits<float>::quiet_NaN()}) {
        nearness[random() % nearness.size()] = special;
      }
      const SourcePositionRow row{nearness.data(), width, 11, 37, 29};
      Positions expected(nearness.size());
      source_positions_row(back, row, expected.outputs());
      for (std::size_t u = 0; u < nearness.size(); ++u) {
        ASSERT_TRUE(expected.column[u] >= -1 && expected.column[u] < 37);
        ASSERT_TRUE(expected.line[u] >= -1 && expected.line[u] < 29);
      }
      for_each_target([&] {
        Positions found(nearness.size());
        source_positions_row(back, row, found.outputs());
        ASSERT_EQ(found.column, expected.column);
        ASSERT_EQ(found.line, expected.line);
        ASSERT_EQ(found.fraction_x, expected.fraction_x);
        ASSERT_EQ(found.fraction_y, expected.fraction_y);
        ASSERT_TRUE(are_same(found.disparity_px, expected.disparity_px));
        ASSERT_TRUE(are_same(found.nearness, expected.nearness));
      });
    }
  }
}

}  // namespace vantage::kernels::source_position_test
