#include "kernels/view_blend/view_blend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <type_traits>
#include <vector>

#include "kernels/pixel_row/pixel_row.h"
#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels {
namespace {

template <typename T>
struct View {
  std::vector<T> pixels;
  std::vector<float> disparity_px;
  std::vector<std::uint8_t> holes;

  View(int width, int channels)
      : pixels(static_cast<std::size_t>(width * channels), T{77}),
        disparity_px(static_cast<std::size_t>(width), -5.0F),
        holes(static_cast<std::size_t>(width), 77) {}
  BlendedRow<T> row() { return {pixels.data(), disparity_px.data(), holes.data()}; }
};

BlendWeights some_weights(float alpha, float largest) {
  BlendWeights weights;
  weights.alpha = alpha;
  for (int c = 0; c < 4; ++c) {
    weights.left_scale[c] = 1.1F - 0.1F * static_cast<float>(c);
    weights.left_offset[c] = (0.02F * static_cast<float>(c) - 0.03F) * largest;
    weights.right_scale[c] = 0.9F + 0.05F * static_cast<float>(c);
    weights.right_offset[c] = 0.04F * largest;
  }
  return weights;
}

template <typename T>
class ViewBlend : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, std::uint16_t, float>;
TYPED_TEST_SUITE(ViewBlend, PixelTypes);

TYPED_TEST(ViewBlend, EqualOnEveryInstructionSetAndToReference) {
  std::mt19937 random(8);
  constexpr float kLargest = kLargestValue<TypeParam>;
  for (const int width : kAwkwardWidths) {
    for (const int channels : {1, 3, 4}) {
      for (const float alpha : {0.0F, 0.3F, 1.0F}) {
        const RandomPair pair(random, width, channels, kLargest);
        const BlendWeights weights = some_weights(alpha, kLargest);
        View<TypeParam> expected(width, channels);
        const int holes = blend_row_ref(pair.row, weights, channels, expected.row());
        for_each_target([&] {
          View<TypeParam> view(width, channels);
          ASSERT_EQ(blend_row(pair.row, weights, channels, view.row()), holes);
          ASSERT_EQ(view.pixels, expected.pixels) << width << " wide, " << channels << " channels";
          ASSERT_EQ(view.holes, expected.holes);
          for (std::size_t x = 0; x < view.holes.size(); ++x) {
            ASSERT_TRUE(view.holes[x] != 0 ? std::isnan(view.disparity_px[x])
                                           : view.disparity_px[x] == expected.disparity_px[x]);
          }
        });
      }
    }
  }
}

// (3.12) and its exceptions, once more in double and case by case.
TYPED_TEST(ViewBlend, FollowsTheEquation) {
  std::mt19937 random(9);
  constexpr float kLargest = kLargestValue<TypeParam>;
  const double alpha = 0.35F;
  const int width = 300;
  const RandomPair pair(random, width, 3, kLargest);
  const BlendWeights weights = some_weights(0.35F, kLargest);
  View<TypeParam> view(width, 3);
  blend_row(pair.row, weights, 3, view.row());
  for (int x = 0; x < width; ++x) {
    const auto i = static_cast<std::size_t>(x);
    const bool has_left = !std::isnan(pair.left_d[i]);
    const bool has_right = !std::isnan(pair.right_d[i]);
    EXPECT_EQ(view.holes[i] != 0, !has_left && !has_right);
    for (std::size_t c = 0; c < 3; ++c) {
      const double left =
          double{weights.left_scale[c]} * pair.left_colours[4 * i + c] + weights.left_offset[c];
      const double right =
          double{weights.right_scale[c]} * pair.right_colours[4 * i + c] + weights.right_offset[c];
      double value = 0;
      if (has_left && has_right && std::abs(pair.left_d[i] - pair.right_d[i]) <= 1) {
        value = alpha * left + (1 - alpha) * right;
      } else if (has_left && (!has_right || pair.left_d[i] > pair.right_d[i])) {
        value = left;
      } else if (has_right) {
        value = right;
      }
      const double stored = static_cast<double>(view.pixels[3 * i + c]);
      if (std::is_same_v<TypeParam, float>) {
        EXPECT_NEAR(stored, std::clamp(value, 0.0, 1.0), 1e-6);
      } else {
        EXPECT_NEAR(stored, std::clamp(value, 0.0, double{kLargest}), 0.51);
      }
    }
  }
}

}  // namespace
}  // namespace vantage::kernels
