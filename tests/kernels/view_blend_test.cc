#include "kernels/view_blend/view_blend.h"

#include <type_traits>

#include "kernels/forward_warp/forward_warp.h"
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

/// By (3.12) and its exceptions: the share of the left image at x.
double left_share(const RandomPair& pair, const BlendWeights& weights, std::size_t x) {
  const double left_d = pair.left_d[x];
  const double right_d = pair.right_d[x];
  const double alpha = weights.alpha;
  if (std::isnan(left_d) || std::isnan(right_d)) {
    return std::isnan(right_d) ? 1 : 0;
  }
  if (alpha == 0 || alpha == 1) {
    return alpha;  // a camera's own view
  }
  if (std::abs(left_d - right_d) > 1) {
    return left_d > right_d ? 1 : 0;
  }
  // Where a surface ends in one of the images, that image counts less.
  const auto trust = [&](const std::vector<float>& d) -> double {
    const auto ends = [&](std::size_t at) { return !(std::abs(d[at] - d[x]) <= 1); };
    const bool ends_here = (x > 0 && ends(x - 1)) || (x + 1 < d.size() && ends(x + 1));
    return ends_here ? weights.trust_at_ends : 1;
  };
  const double left = alpha * trust(pair.left_d);
  return left / (left + (1 - alpha) * trust(pair.right_d));
}

/// What blend_row() makes of a pair, of which nothing may be missing.
template <typename T>
void expect_blended(const RandomPair& pair, const BlendWeights& weights, int channels,
                    const View<T>& view) {
  const double tolerance = std::is_same_v<T, float> ? 2e-6 : 0.51;
  const auto known = [](float d) { return std::isnan(d) ? 0.0 : double{d}; };
  for (std::size_t x = 0; x < view.holes.size(); ++x) {
    const bool is_hole = std::isnan(pair.left_d[x]) && std::isnan(pair.right_d[x]);
    const double share = left_share(pair, weights, x);
    ASSERT_EQ(view.holes[x], is_hole ? 255 : 0);
    ASSERT_EQ(view.sources[x], is_hole ? 0 : (share > 0 ? 85 : 0) + (share < 1 ? 170 : 0));
    ASSERT_EQ(std::isnan(view.disparity_px[x]), is_hole);
    if (!is_hole) {
      ASSERT_NEAR(view.disparity_px[x],
                  share * known(pair.left_d[x]) + (1 - share) * known(pair.right_d[x]), 1e-5);
    }
    for (int c = 0; c < channels; ++c) {
      const double left = pair.left_colours[x * pair.row.lanes + c];
      const double right = pair.right_colours[x * pair.row.lanes + c];
      const double value = share * (weights.left_scale[c] * left + weights.left_offset[c]) +
                           (1 - share) * (weights.right_scale[c] * right + weights.right_offset[c]);
      const double expected = std::clamp(value, 0.0, double{kLargestValue<T>});
      ASSERT_NEAR(static_cast<double>(view.pixels[x * channels + c]), is_hole ? 0 : expected,
                  tolerance)
          << "position " << x << ", channel " << c;
    }
  }
}

template <typename T>
class ViewBlend : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, std::uint16_t, float>;
TYPED_TEST_SUITE(ViewBlend, PixelTypes);

TYPED_TEST(ViewBlend, FollowsTheEquationOnEveryInstructionSet) {
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
        View<TypeParam> first(width, channels);
        const int holes = blend_row(pair.row, weights, channels, first.row());
        EXPECT_EQ(holes, std::ranges::count(first.holes, 255));
        expect_blended(pair, weights, channels, first);
        ASSERT_FALSE(this->HasFatalFailure()) << width << " wide, " << channels << " channels";
        for_each_target([&] {
          View<TypeParam> view(width, channels);
          ASSERT_EQ(blend_row(pair.row, weights, channels, view.row()), holes);
          ASSERT_EQ(view.pixels, first.pixels) << width << " wide, " << channels << " channels";
          ASSERT_EQ(view.holes, first.holes);
          ASSERT_EQ(view.sources, first.sources);
          ASSERT_TRUE(are_same(view.disparity_px, first.disparity_px));
        });
      }
    }
  }
}

/// One image of a pair, warped by `s` from a map with jumps.
template <typename T>
struct FetchedImage {
  RowWithMargins map;
  std::vector<float> warped_px;
  PlanesWithMargins planes;
  BicubicFetchRow row;

  FetchedImage(const std::vector<float>& d, const std::vector<T>& pixels, int channels, double s)
      : map(d, kUnknownDisparity),
        warped_px(d.size()),
        planes(pixels.data(), static_cast<int>(d.size()), channels) {
    const auto width = static_cast<int>(d.size());
    forward_warp_row({d.data(), width, s, 1}, warped_px.data(), nullptr);
    row = {planes.row(),
           planes.stride(),
           map.row(),
           warped_px.data(),
           width,
           channels,
           s,
           1.0F,
           kLargestValue<T>,
           std::is_integral_v<T>};
  }
};

TYPED_TEST(ViewBlend, OfFetchedRowsIsThatOfStoredOnes) {
  using T = TypeParam;
  std::mt19937 random(9);
  for (const int width : kAwkwardWidths) {
    for (const int channels : {1, 3, 4}) {
      const auto image = [&](double s) {
        std::vector<T> pixels(width * channels);
        for (T& value : pixels) {
          value = static_cast<T>(static_cast<double>(random() % 1001) / 1000 * kLargestValue<T>);
        }
        return FetchedImage<T>(random_disparities(random, width, 0, 9), pixels, channels, s);
      };
      const FetchedImage<T> left = image(0.4);
      const FetchedImage<T> right = image(-0.6);
      const int lanes = pixel_lanes(channels);
      std::vector<float> left_colours(width * lanes);
      std::vector<float> right_colours(width * lanes);
      fetch_bicubic_row(left.row, left_colours.data());
      fetch_bicubic_row(right.row, right_colours.data());
      for (const float trust : {1.0F, 0.1F}) {
        BlendWeights weights = some_weights(0.6F, kLargestValue<T>);
        weights.trust_at_ends = trust;
        View<T> expected(width, channels);
        const int holes =
            blend_row({left_colours.data(), right_colours.data(), left.warped_px.data(),
                       right.warped_px.data(), width, lanes, 1.0F},
                      weights, channels, expected.row());
        for_each_target([&] {
          View<T> view(width, channels);
          ASSERT_EQ(blend_fetched_row({left.row, right.row, {}}, weights, view.row()), holes);
          ASSERT_EQ(view.pixels, expected.pixels) << width << " wide, " << channels << " channels";
          ASSERT_EQ(view.holes, expected.holes);
          ASSERT_EQ(view.sources, expected.sources);
          ASSERT_TRUE(are_same(view.disparity_px, expected.disparity_px));
        });
      }
    }
  }
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
