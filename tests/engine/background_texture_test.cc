#include "engine/synthesis/background_texture.h"

#include "kernels/pixel_row/pixel_row.h"
#include "tests/engine/engine_test.h"

namespace vantage::background_texture_test {

/// A background of slanted stripes, with holes beside bright objects in front of it.
template <typename T>
struct Scene {
  Image<T> image;
  Mask wanted;
  DisparityMap disparity_px;

  Scene(int width, int height, int channels)
      : image(width, height, channels), wanted(width, height), disparity_px(width, height) {
    wanted.fill(0);
    disparity_px.fill(2);
    for (const auto [x, y] : positions_of(width, height)) {
      set(x, y, stripe(x, y));
    }
  }
  static double stripe(int x, int y) { return 0.1 * static_cast<double>((x + 2 * y) % 7); }
  static T level(double part) { return static_cast<T>(part * kernels::kLargestValue<T>); }
  void set(int x, int y, double part) {
    for (int c = 0; c < image.channels(); ++c) {
      image.at(x, y, c) = level(c == 1 ? part / 2 : part);
    }
  }
  void add_object(int x, int y) {
    disparity_px.at(x, y) = 9;
    set(x, y, 1);
  }
  void cut(int x, int y) {
    wanted.at(x, y) = 255;
    set(x, y, 0.95);
  }
  void synthesize(int threads) {
    Execution execution({.threads = threads});
    synthesize_background_texture(image.view(), std::as_const(wanted).view(),
                                  std::as_const(disparity_px).view(), 1, execution);
  }
};

template <typename T>
class BackgroundTexture : public testing::Test {};
TYPED_TEST_SUITE(BackgroundTexture, PixelTypes);

/// Holes at the right and left of two objects, one of them narrower than a patch.
template <typename T>
Scene<T> scene_with_objects(int channels) {
  Scene<T> scene(90, 61, channels);
  for (const auto [x, y] : positions_of(90, 61)) {
    if (x >= 50 && x < 60) {
      scene.add_object(x, y);
    } else if ((x >= 60 && x < 74 && y > 12 && y < 50) || (x >= 47 && x < 50 && y < 40)) {
      scene.cut(x, y);
    }
  }
  return scene;
}

TYPED_TEST(BackgroundTexture, GoesOnAndIsNeverTheObjects) {
  for (const int channels : {1, 3, 4}) {
    Scene<TypeParam> scene = scene_with_objects<TypeParam>(channels);
    const Scene<TypeParam> before = scene_with_objects<TypeParam>(channels);
    const Scene<TypeParam> truth(90, 61, channels);
    scene.synthesize(2);
    int wrong = 0;
    for (const auto [x, y] : positions_of(90, 61)) {
      for (int c = 0; c < channels; ++c) {
        if (scene.wanted.at(x, y) == 0) {
          ASSERT_EQ(scene.image.at(x, y, c), before.image.at(x, y, c));
          continue;
        }
        ASSERT_LE(scene.image.at(x, y, c), Scene<TypeParam>::level(0.6)) << x << ", " << y;
        wrong += scene.image.at(x, y, c) == truth.image.at(x, y, c) ? 0 : 1;
      }
    }
    EXPECT_EQ(wrong, 0);
    Scene<TypeParam> on_one_thread = scene_with_objects<TypeParam>(channels);
    on_one_thread.synthesize(1);
    for (const auto [k, y] : positions_of(90 * channels, 61)) {
      ASSERT_EQ(scene.image.row(y)[k], on_one_thread.image.row(y)[k]);
    }
  }
}

/// The object is a copy of what is at the left of the hole, and bright where the hole would be.
TEST(BackgroundTextureOfNoise, TakesNothingFromSurfacesInFront) {
  constexpr int kHole = 60;
  constexpr int kShift = 30;
  Scene<std::uint8_t> scene(90, 40, 3);
  std::mt19937 random(7);
  for (const auto [x, y] : positions_of(90, 40)) {
    scene.set(x, y, 0.1 * static_cast<double>(random() % 6));
  }
  for (int y = 0; y < 40; ++y) {
    for (int x = 20; x < 40; ++x) {
      scene.add_object(x, y);
      if (x + kShift < kHole) {
        std::copy_n(&scene.image.at(x + kShift, y), 3, &scene.image.at(x, y));
      }
    }
    for (int x = kHole; x < kHole + 7; ++x) {
      scene.cut(x, y);
    }
  }
  scene.synthesize(1);
  for (const auto [x, y] : positions_of({kHole, kHole + 7}, {0, 40})) {
    ASSERT_LE(scene.image.at(x, y), Scene<std::uint8_t>::level(0.5)) << x << ", " << y;
  }
}

/// Without a source the values before stay.
TYPED_TEST(BackgroundTexture, OfImagesOfAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {5, 3}, {9, 9}, {30, 10}}) {
    Scene<TypeParam> all(width, height, 3);
    Scene<TypeParam> column(width, height, 3);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        all.cut(x, y);
        all.disparity_px.at(x, y) = std::numeric_limits<float>::quiet_NaN();
      }
      column.cut(width / 2, y);
    }
    all.synthesize(1);
    column.synthesize(1);
    EXPECT_EQ(all.image.at(width - 1, height - 1), Scene<TypeParam>::level(0.95));
    const double wanted = width < 30 ? 0.95 : Scene<TypeParam>::stripe(width / 2, 1);
    EXPECT_EQ(column.image.at(width / 2, height > 1 ? 1 : 0), Scene<TypeParam>::level(wanted));
  }
}

}  // namespace vantage::background_texture_test
