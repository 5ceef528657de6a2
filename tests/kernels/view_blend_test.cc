#include "kernels/view_blend/view_blend.h"

#include <type_traits>

#include "kernels/pixel_row/pixel_row.h"
#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::view_blend_test {

template <typename T>
struct View {
  std::vector<T> pixels;
  std::vector<float> disparity_px;
  std::vector<std::uint8_t> holes;
  std::vector<std::uint8_t> sources;

  View(int width, int channels)
      : pixels(static_cast<std::size_t>(width * channels), T{77}),
        disparity_px(static_cast<std::size_t>(width), -5.0F),
        holes(static_cast<std::size_t>(width), 77),
        sources(static_cast<std::size_t>(width), 77) {}
  BlendedRow<T> row() { return {pixels.data(), disparity_px.data(), holes.data(), sources.data()}; }
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

// Disparities that go on for a while, as of surfaces; colours stay as they are.
void make_surfaces(std::mt19937& random, RandomPair& pair) {
  for (std::size_t x = 1; x < pair.left_d.size(); ++x) {
    if (random() % 4 != 0) {
      pair.left_d[x] = pair.left_d[x - 1];
    }
    pair.right_d[x] = random() % 5 == 0   ? kUnknownDisparity
                      : random() % 5 == 0 ? pair.left_d[x] + 3
                                          : pair.left_d[x];
  }
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
        RandomPair pair(random, width, channels, kLargest);
        BlendWeights weights = some_weights(alpha, kLargest);
        if (random() % 2 == 0) {
          make_surfaces(random, pair);
          weights.trust_at_ends = 0.3F;
        }
        View<TypeParam> expected(width, channels);
        const int holes = blend_row_ref(pair.row, weights, channels, expected.row());
        for_each_target([&] {
          View<TypeParam> view(width, channels);
          ASSERT_EQ(blend_row(pair.row, weights, channels, view.row()), holes);
          ASSERT_EQ(view.pixels, expected.pixels) << width << " wide, " << channels << " channels";
          ASSERT_EQ(view.holes, expected.holes);
          ASSERT_EQ(view.sources, expected.sources);
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

// Where a surface ends in one of the images, that image counts less.
TYPED_TEST(ViewBlend, TrustsImagesLessWhereTheirSurfaceEnds) {
  std::mt19937 random(10);
  constexpr float kLargest = kLargestValue<TypeParam>;
  const int width = 400;
  RandomPair pair(random, width, 1, kLargest);
  make_surfaces(random, pair);
  BlendWeights weights;
  weights.alpha = 0.35F;
  weights.trust_at_ends = 0.25F;
  View<TypeParam> view(width, 1);
  blend_row(pair.row, weights, 1, view.row());
  const double tolerance = std::is_floating_point_v<TypeParam> ? 1e-6 : 0.51;
  int with_unequal_trust = 0;
  const auto trust = [&](const std::vector<float>& d, std::size_t x) {
    const auto ends = [&](std::size_t at) { return !(std::abs(d[at] - d[x]) <= 1); };
    return (x > 0 && ends(x - 1)) || (x + 1 < d.size() && ends(x + 1)) ? 0.25 : 1.0;
  };
  for (std::size_t x = 0; x < width; ++x) {
    if (!(std::abs(pair.left_d[x] - pair.right_d[x]) <= 1)) {
      continue;
    }
    const double left = double{weights.alpha} * trust(pair.left_d, x);
    const double right = (1 - double{weights.alpha}) * trust(pair.right_d, x);
    with_unequal_trust += trust(pair.left_d, x) != trust(pair.right_d, x) ? 1 : 0;
    const double value =
        (left * pair.left_colours[x] + right * pair.right_colours[x]) / (left + right);
    EXPECT_NEAR(static_cast<double>(view.pixels[x]), value, tolerance);
  }
  EXPECT_GT(with_unequal_trust, 50);
}

TEST(ViewBlendSources, NameTheImages) {
  const std::vector<float> left_d = {5, 5, kUnknownDisparity, kUnknownDisparity, 9, 2};
  const std::vector<float> right_d = {5, kUnknownDisparity, 5, kUnknownDisparity, 5, 5};
  const std::vector<float> colours(6, 100);
  const WarpedPairRow pair{colours.data(), colours.data(), left_d.data(), right_d.data(), 6, 1, 1};
  View<std::uint8_t> view(6, 1);
  blend_row(pair, {}, 1, view.row());
  EXPECT_EQ(view.sources, (std::vector<std::uint8_t>{255, 85, 170, 0, 85, 170}));
  blend_row(pair, {.alpha = 1}, 1, view.row());  // a camera's own view
  EXPECT_EQ(view.sources, (std::vector<std::uint8_t>{85, 85, 170, 0, 85, 85}));
  BlendedRow<std::uint8_t> without = view.row();
  without.sources = nullptr;
  EXPECT_EQ(blend_row(pair, {}, 1, without), 1);
}

}  // namespace vantage::kernels::view_blend_test
