#include "kernels/photograph_position/photograph_position.h"

#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::photograph_position_test {

VANTAGE_ON_EVERY_TARGET(PhotographPositionTargets);

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr int kSizes[][2] = {{1, 1}, {2, 1}, {1, 7}, {2, 2}, {13, 5}, {37, 29}};

/// Tables of a rectified image, with rows that are longer than it.
class Tables {
 public:
  Tables(int width, int height)
      : width_(width),
        height_(height),
        x_(static_cast<std::size_t>((width + kPadding) * height), kUnknown),
        y_(x_) {}

  float& x(int column, int line) { return x_[index(column, line)]; }
  float& y(int column, int line) { return y_[index(column, line)]; }
  [[nodiscard]] PhotographTable table(int photograph_width, int photograph_height) const {
    return {x_.data(), y_.data(),        width_ + kPadding, width_,
            height_,   photograph_width, photograph_height};
  }

 private:
  static constexpr int kPadding = 3;
  [[nodiscard]] std::size_t index(int column, int line) const {
    return static_cast<std::size_t>(line * (width_ + kPadding) + column);
  }
  int width_;
  int height_;
  std::vector<float> x_;
  std::vector<float> y_;
};

/// Positions as source_positions_row() makes them, some of them holes.
struct Row {
  std::vector<std::int32_t> column, line;
  std::vector<float> fraction_x, fraction_y, disparity_px;

  Row(std::mt19937& random, int count, int width, int height) {
    for (int n = 0; n < count; ++n) {
      const bool is_hole = random() % 7 == 0;
      const double x =
          is_hole ? 0 : -1 + (width + 0.5) * static_cast<double>(random()) / 4294967295;
      const double y =
          is_hole ? 0 : -1 + (height + 0.5) * static_cast<double>(random()) / 4294967295;
      column.push_back(static_cast<std::int32_t>(std::floor(x)));
      line.push_back(static_cast<std::int32_t>(std::floor(y)));
      fraction_x.push_back(static_cast<float>(x - std::floor(x)));
      fraction_y.push_back(static_cast<float>(y - std::floor(y)));
      disparity_px.push_back(is_hole ? kUnknown : static_cast<float>(random() % 100) / 4);
    }
  }
  [[nodiscard]] SourcePositions in_place() {
    return {.column = column.data(),
            .line = line.data(),
            .fraction_x = fraction_x.data(),
            .fraction_y = fraction_y.data(),
            .disparity_px = disparity_px.data()};
  }
  [[nodiscard]] int count() const { return static_cast<int>(column.size()); }
};

// A bilinear table is interpolated and carried on beyond its borders as the formula says.
TEST(PhotographPosition, FollowsABilinearTable) {
  const auto in_photograph_x = [](double x, double y) {
    return 3 + 0.9 * x - 0.1 * y + 0.01 * x * y;
  };
  const auto in_photograph_y = [](double x, double y) {
    return 4 + 0.2 * x + 1.1 * y - 0.02 * x * y;
  };
  std::mt19937 random(1);
  int inside = 0;
  int outside = 0;
  for (const auto& [width, height] : kSizes) {
    Tables tables(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        tables.x(x, y) = static_cast<float>(in_photograph_x(x, y));
        tables.y(x, y) = static_cast<float>(in_photograph_y(x, y));
      }
    }
    const PhotographTable table = tables.table(31, 17);
    for (const int count : kAwkwardWidths) {
      const Row given(random, count, width, height);
      Row found = given;
      photograph_positions_row(table, found.in_place(), count);
      for (std::size_t n = 0; n < given.column.size(); ++n) {
        if (std::isnan(given.disparity_px[n])) {
          ASSERT_TRUE(std::isnan(found.disparity_px[n]));
          continue;
        }
        // A single row or column has nothing to be carried on from.
        const double x = width == 1 ? 0 : given.column[n] + double{given.fraction_x[n]};
        const double y = height == 1 ? 0 : given.line[n] + double{given.fraction_y[n]};
        const double wanted_x = in_photograph_x(x, y);
        const double wanted_y = in_photograph_y(x, y);
        const double margin =
            std::min({wanted_x + 0.5, 30.5 - wanted_x, wanted_y + 0.5, 16.5 - wanted_y});
        if (margin < -1e-4) {
          ASSERT_TRUE(std::isnan(found.disparity_px[n]));
          ASSERT_EQ(found.column[n], 0);
          ASSERT_EQ(found.fraction_y[n], 0);
          ++outside;
        } else if (margin > 1e-4) {
          ASSERT_EQ(found.disparity_px[n], given.disparity_px[n]);
          ASSERT_NEAR(found.column[n] + double{found.fraction_x[n]}, wanted_x, 1e-5);
          ASSERT_NEAR(found.line[n] + double{found.fraction_y[n]}, wanted_y, 1e-5);
          ASSERT_TRUE(found.fraction_x[n] >= 0 && found.fraction_x[n] < 1);
          ASSERT_TRUE(found.fraction_y[n] >= 0 && found.fraction_y[n] < 1);
          ++inside;
        }
      }
    }
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 100);
}

TEST(PhotographPosition, WhatTheCameraDoesNotSeeIsNowhere) {
  Tables tables(2, 2);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) {
      tables.x(x, y) = static_cast<float>(x);
      tables.y(x, y) = static_cast<float>(y);
    }
  }
  tables.x(1, 1) = tables.y(1, 1) = kUnknown;
  std::mt19937 random(2);
  Row row(random, 40, 2, 2);
  photograph_positions_row(tables.table(2, 2), row.in_place(), row.count());
  for (int n = 0; n < row.count(); ++n) {
    EXPECT_TRUE(std::isnan(row.disparity_px[n]));
    EXPECT_EQ(row.column[n], 0);
  }
}

TEST_P(PhotographPositionTargets, EqualsTheReference) {
  std::mt19937 random(3);
  const auto value = [&](int size) {
    return random() % 11 == 0
               ? kUnknown
               : static_cast<float>(random() % static_cast<unsigned>(64 * size)) / 50;
  };
  for (const auto& [width, height] : kSizes) {
    Tables tables(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        tables.x(x, y) = value(width);
        tables.y(x, y) = value(height);
      }
    }
    const PhotographTable table = tables.table(width, height);
    for (const int count : kAwkwardWidths) {
      Row found(random, count, width, height);
      Row expected = found;
      photograph_positions_row_ref(table, expected.in_place(), count);
      photograph_positions_row(table, found.in_place(), count);
      ASSERT_EQ(found.column, expected.column);
      ASSERT_EQ(found.line, expected.line);
      ASSERT_EQ(found.fraction_x, expected.fraction_x);
      ASSERT_EQ(found.fraction_y, expected.fraction_y);
      ASSERT_TRUE(std::equal(
          found.disparity_px.begin(), found.disparity_px.end(), expected.disparity_px.begin(),
          [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
    }
  }
}

}  // namespace vantage::kernels::photograph_position_test
