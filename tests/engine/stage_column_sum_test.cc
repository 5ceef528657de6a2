#include "engine/matching/aggregation/stage_column_sum.h"

#include "tests/engine/cell_stages.h"
#include "tests/engine/engine_test.h"

namespace vantage::stage_column_sum_test {

using kernels::CandidateGeometry;
using scheduler::Extent;

/// Costs of random_cells() lie within 100 of this; they are multiples of 1/8.
constexpr float kMinCost = -37;

struct Shape {
  Extent extent;
  int disparity_min;
  int count;
  int radius;
};
void PrintTo(const Shape& shape, std::ostream* stream) {
  *stream << shape.extent.columns << "x" << shape.extent.rows << ", disparities from "
          << shape.disparity_min << ", " << shape.count << " of them, radius " << shape.radius;
}

class ColumnSums : public ::testing::TestWithParam<std::tuple<Shape, int>> {
 protected:
  ColumnSums()
      : shape_(std::get<0>(GetParam())),
        geometry_{shape_.extent.columns, shape_.disparity_min, shape_.count,
                  std::get<1>(GetParam())},
        costs_(random_cells(shape_.extent, geometry_.lanes(), kMinCost, 8)) {}

  [[nodiscard]] std::unique_ptr<scheduler::RowStage> make_stage(ColumnSumScale scale) const {
    return make_column_sum_stage(geometry_, shape_.extent.rows, shape_.radius, scale.offset,
                                 scale.scale);
  }
  [[nodiscard]] bool has_partner(int x, int candidate) const {
    const int partner = geometry_.partner(x, candidate);
    return partner >= 0 && partner < shape_.extent.columns;
  }

  Shape shape_;
  CandidateGeometry geometry_;
  CellVolume<float> costs_;
};

INSTANTIATE_TEST_SUITE_P(
    AwkwardSizes, ColumnSums,
    ::testing::Combine(::testing::Values(Shape{{1, 1}, 0, 1, 0}, Shape{{1, 7}, 0, 4, 1},
                                         Shape{{7, 1}, -2, 5, 2}, Shape{{5, 3}, -9, 19, 4},
                                         Shape{{37, 23}, 0, 13, 3}, Shape{{37, 23}, -20, 40, 1},
                                         Shape{{37, 23}, 5, 40, 0}, Shape{{29, 11}, -30, 17, 15}),
                       ::testing::Values(-1, 1)));

TEST_P(ColumnSums, AddRoundedCostsOfTheRowsInTheImage) {
  // A coarse scale: units of 4/3 · 2^-k are no multiples of 1/8.
  const ColumnSumScale scale = {-kMinCost, 0.75F};
  std::vector<std::unique_ptr<scheduler::RowStage>> stages;
  stages.push_back(make_stage(scale));
  const CellVolume<std::int32_t> sums = run_every_way<std::int32_t>(costs_, stages);
  for (const auto [x, y] : positions_of(shape_.extent.columns, shape_.extent.rows)) {
    for (int i = 0; i < shape_.count; ++i) {
      std::int32_t expected = 0;
      for (int v = std::max(0, y - shape_.radius);
           v <= std::min(shape_.extent.rows - 1, y + shape_.radius); ++v) {
        expected += static_cast<std::int32_t>(
            std::nearbyint((costs_.at(x, v, i) + scale.offset) * scale.scale));
      }
      if (has_partner(x, i)) {
        ASSERT_EQ(sums.at(x, y, i), expected) << x << ", " << y << ", candidate " << i;
      } else if ((i > 0 && has_partner(x, std::max(0, i - shape_.radius))) ||
                 has_partner(x, std::min(shape_.count - 1, i + shape_.radius))) {
        ASSERT_EQ(sums.at(x, y, i), 0) << x << ", " << y << ", candidate " << i;
      }
    }
  }
}

TEST(ColumnSumScale, LeavesRoomForTheSumOfAWindow) {
  for (const int window_px : {1, 3, 9, 21, 101, 181}) {
    for (const auto& [min, largest] : {std::pair{0.0F, 65025.0F},
                                       {-140.0F, 140.0F},
                                       {0.0F, 1e-3F},
                                       {3.0F, 3.5F},
                                       {-1e6F, 1e6F},
                                       {0.0F, 63.0F},
                                       {0.0F, 1e-40F}}) {
      SCOPED_TRACE(::testing::Message() << min << " to " << largest << ", window " << window_px);
      const ColumnSumScale scale = column_sum_scale(min, largest, window_px);
      EXPECT_EQ(min + scale.offset, 0);
      int exponent = 0;
      EXPECT_EQ(std::frexp(scale.scale, &exponent), 0.5) << "not a power of two";
      const auto fits = [&](double factor) {
        const double max = std::round((static_cast<double>(largest) - min) * factor);
        return max < 4194304 && max * window_px * window_px < 2147483647.0;
      };
      EXPECT_TRUE(fits(scale.scale));
      EXPECT_TRUE(scale.scale > 1e30F || !fits(2.1 * scale.scale)) << scale.scale;
    }
  }
}

TEST(ColumnSumScale, TakesCostsThatAreAllAlike) {
  const ColumnSumScale scale = column_sum_scale(5, 5, 9);
  EXPECT_EQ(scale.offset, -5);
  EXPECT_EQ(scale.scale, 1);
}

}  // namespace vantage::stage_column_sum_test
