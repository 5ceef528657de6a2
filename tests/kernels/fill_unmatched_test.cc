#include "kernels/fill_unmatched/fill_unmatched.h"

#include <bit>
#include <optional>

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::fill_unmatched_test {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// EQUATIONS §5.4 for one pixel: the nearest matched pixel on the background's side, else on the
/// other one.
std::optional<std::size_t> source_of(const std::vector<std::uint8_t>& unmatched,
                                     BackgroundSide side, std::size_t x) {
  std::optional<std::size_t> left;
  std::optional<std::size_t> right;
  for (std::size_t i = 0; i < unmatched.size(); ++i) {
    if (unmatched[i] != 0) {
      continue;
    }
    if (i <= x) {
      left = i;
    }
    if (i >= x && !right) {
      right = i;
    }
  }
  return side == BackgroundSide::kLeft ? (left ? left : right) : (right ? right : left);
}

/// Bits, so that unknown values compare.
std::vector<std::uint32_t> bits(const std::vector<float>& values) {
  std::vector<std::uint32_t> result;
  for (const float value : values) {
    result.push_back(std::bit_cast<std::uint32_t>(value));
  }
  return result;
}

TEST(FillUnmatched, EqualsPlainTranscription) {
  std::mt19937 random(61);
  for (int width = 1; width <= 70; ++width) {
    for (unsigned sparsity = 1; sparsity <= 6; ++sparsity) {
      for (const BackgroundSide side : {BackgroundSide::kLeft, BackgroundSide::kRight}) {
        std::vector<std::uint8_t> unmatched(width);
        std::vector<float> disparity_px(unmatched.size());
        for (std::size_t x = 0; x < unmatched.size(); ++x) {
          // Runs, at the borders too; any value but 0 marks.
          const bool repeats = x > 0 && random() % 3 != 0;
          unmatched[x] =
              repeats
                  ? unmatched[x - 1]
                  : static_cast<std::uint8_t>(random() % sparsity == 0 ? 1 + random() % 255 : 0);
          disparity_px[x] = unmatched[x] != 0 && random() % 2 == 0
                                ? kUnknown
                                : static_cast<float>(random() % 1000) / 4;
        }
        bool any = false;
        std::vector<float> expected = disparity_px;
        for (std::size_t x = 0; x < unmatched.size(); ++x) {
          if (const auto source = source_of(unmatched, side, x)) {
            any = true;
            expected[x] = disparity_px[*source];
          }
        }
        ASSERT_EQ(fill_unmatched_row(unmatched.data(), side, width, disparity_px.data()), any);
        ASSERT_EQ(bits(disparity_px), bits(expected)) << "width " << width;
      }
    }
  }
}

std::vector<float> filled(const std::vector<std::uint8_t>& unmatched, BackgroundSide side,
                          std::vector<float> disparity_px) {
  EXPECT_TRUE(fill_unmatched_row(unmatched.data(), side, static_cast<int>(unmatched.size()),
                                 disparity_px.data()));
  return disparity_px;
}

TEST(FillUnmatched, TakesTheBackgroundsSideAndTheOtherAtTheBorder) {
  using Row = std::vector<float>;
  const std::vector<std::uint8_t> unmatched = {255, 255, 0, 255, 255, 0, 255};
  const Row row = {kUnknown, 9, 3, kUnknown, 9, 5, kUnknown};
  EXPECT_EQ(filled(unmatched, BackgroundSide::kLeft, row), (Row{3, 3, 3, 3, 3, 5, 5}));
  EXPECT_EQ(filled(unmatched, BackgroundSide::kRight, row), (Row{3, 3, 3, 5, 5, 5, 5}));
  EXPECT_EQ(filled({0}, BackgroundSide::kRight, {4}), Row{4});
}

TEST(FillUnmatched, RowWithoutAMatchStaysAsItIs) {
  for (const BackgroundSide side : {BackgroundSide::kLeft, BackgroundSide::kRight}) {
    std::vector<float> disparity_px = {kUnknown, 2, 7};
    const std::vector<float> before = disparity_px;
    EXPECT_FALSE(
        fill_unmatched_row(std::vector<std::uint8_t>(3, 255).data(), side, 3, disparity_px.data()));
    EXPECT_EQ(bits(disparity_px), bits(before));
  }
}

TEST(FillUnmatchedLinearly, InterpolatesWhereBothSidesAreOneSurface) {
  using Row = std::vector<float>;
  const auto linear = [](std::vector<std::uint8_t> unmatched, BackgroundSide side, Row row) {
    EXPECT_TRUE(fill_unmatched_row_linearly(unmatched.data(), side, 1,
                                            static_cast<int>(unmatched.size()), row.data()));
    return row;
  };
  for (const BackgroundSide side : {BackgroundSide::kLeft, BackgroundSide::kRight}) {
    EXPECT_EQ(linear({0, 255, 255, 255, 0}, side, {4, kUnknown, 9, 9, 5}),
              (Row{4, 4.25F, 4.5F, 4.75F, 5}));
    EXPECT_EQ(linear({0, 1, 0}, side, {4, 0, 3}), (Row{4, 3.5F, 3}));
    EXPECT_EQ(linear({0, 1, 0}, side, {4, 0, 4}), (Row{4, 4, 4}));
    // Runs at the border have one side only.
    EXPECT_EQ(linear({255, 0, 255}, side, {9, 4, 9}), (Row{4, 4, 4}));
  }
  // Different surfaces: constant depth.
  EXPECT_EQ(linear({0, 255, 0}, BackgroundSide::kLeft, {4, 9, 5.25F}), (Row{4, 4, 5.25F}));
  EXPECT_EQ(linear({0, 255, 0}, BackgroundSide::kRight, {4, 9, 5.25F}), (Row{4, 5.25F, 5.25F}));
  Row row = {1, 2};
  EXPECT_FALSE(fill_unmatched_row_linearly(std::vector<std::uint8_t>(2, 255).data(),
                                           BackgroundSide::kLeft, 1, 2, row.data()));
  EXPECT_EQ(row, (Row{1, 2}));
}

}  // namespace vantage::kernels::fill_unmatched_test
