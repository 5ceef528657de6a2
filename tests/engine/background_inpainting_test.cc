#include "engine/synthesis/background_inpainting.h"

#include "engine/matching/stereo_matcher.h"
#include "kernels/pixel_row/pixel_row.h"
#include "tests/engine/engine_test.h"

namespace vantage::background_inpainting_test {

template <typename T>
struct Scene {
  Image<T> image;
  Mask wanted;
  DisparityMap disparity_px;

  // A background of about a quarter of the range; 0 where it is to be painted.
  Scene(int width, int height, int channels)
      : image(width, height, channels), wanted(width, height), disparity_px(width, height) {
    std::mt19937 random(41);
    wanted.fill(0);
    disparity_px.fill(2);
    for (const auto [k, y] : positions_of(width * channels, height)) {
      image.row(y)[k] = level(0.25 + 0.02 * static_cast<double>(random() % 2));
    }
  }
  static T level(double part) { return static_cast<T>(part * kernels::kLargestValue<T>); }
  void cut(int x, int y) {
    wanted.at(x, y) = 255;
    for (int c = 0; c < image.channels(); ++c) {
      image.at(x, y, c) = 0;
    }
  }
  void paint() {
    inpaint_background(image.view(), std::as_const(wanted).view(),
                       std::as_const(disparity_px).view(), 1);
  }
};

template <typename T>
class BackgroundInpainting : public testing::Test {};
TYPED_TEST_SUITE(BackgroundInpainting, PixelTypes);

// A bright object covers the hole's left side, from top to bottom; a wire crosses its right side.
TYPED_TEST(BackgroundInpainting, LooksAtTheBackgroundOnly) {
  for (const int channels : {1, 3, 4}) {
    Scene<TypeParam> scene(60, 47, channels);
    const auto bright = [&](int x, int y) {
      scene.disparity_px.at(x, y) = 9;
      for (int c = 0; c < channels; ++c) {
        scene.image.at(x, y, c) = Scene<TypeParam>::level(1);
      }
    };
    for (const auto [x, y] : positions_of(60, 47)) {
      if (x < 20 || x == 42) {
        bright(x, y);
      } else if (x < 40 && y > 5 && y < 40) {
        scene.cut(x, y);
      }
    }
    const Image<TypeParam> before = scene.image.copy();
    scene.paint();
    for (const auto [x, y] : positions_of(60, 47)) {
      for (int c = 0; c < channels; ++c) {
        const double value = static_cast<double>(scene.image.at(x, y, c));
        if (scene.wanted.at(x, y) == 0) {
          ASSERT_EQ(scene.image.at(x, y, c), before.at(x, y, c));
        } else {
          // The method extrapolates gradients a little.
          ASSERT_GT(value, 0.1 * kernels::kLargestValue<TypeParam>) << x << ", " << y;
          ASSERT_LT(value, 0.4 * kernels::kLargestValue<TypeParam>) << x << ", " << y;
        }
      }
    }
  }
}

TYPED_TEST(BackgroundInpainting, NothingWantedOrNothingThere) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {30, 20}}) {
    Scene<TypeParam> scene(width, height, 3);
    const TypeParam corner = scene.image.at(0, 0, 0);
    scene.paint();
    EXPECT_EQ(scene.image.at(0, 0, 0), corner);
    for (const auto [x, y] : positions_of(width, height)) {
      scene.cut(x, y);
      scene.disparity_px.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
    scene.paint();
    EXPECT_EQ(scene.image.at(width - 1, height - 1, 2), TypeParam{0});
    scene.wanted.at(0, 0) = 0;
    scene.image.at(0, 0, 1) = Scene<TypeParam>::level(0.5);
    scene.paint();
    EXPECT_EQ(scene.image.at(0, 0, 1), Scene<TypeParam>::level(0.5));
  }
}

TEST(BackgroundInpaintingFloat, KeepsToTheImagesRange) {
  Scene<float> scene(40, 40, 1);
  for (const auto [x, y] : positions_of(40, 40)) {
    scene.image.at(x, y) = static_cast<float>(x) / 10 - 1;  // −1..2.9
    if (x > 30 && y > 10 && y < 30) {
      scene.cut(x, y);
    }
  }
  scene.paint();
  for (const auto [x, y] : positions_of({31, 40}, {0, 40})) {
    ASSERT_GE(scene.image.at(x, y), -1);
    ASSERT_LE(scene.image.at(x, y), 2.9F);
  }
  EXPECT_GT(scene.image.at(32, 20), 1.5F);
}

}  // namespace vantage::background_inpainting_test
