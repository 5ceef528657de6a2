#include "kernels/bicubic_remap/bicubic_remap.h"

#include <type_traits>

#include "kernels/pixel_row/pixel_row.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/synthesis_rows.h"
#include "tests/keys_kernel.h"

namespace vantage::kernels::bicubic_remap_test {

using test::keys;

/// An image that ends where its memory ends, and positions for a row of another one.
template <typename T>
struct Scene {
  int width;
  int height;
  int channels;
  std::ptrdiff_t stride;
  std::vector<T> pixels;
  std::vector<float> x_px;
  std::vector<float> y_px;

  Scene(std::mt19937& random, int w, int h, int c, int count)
      : width(w),
        height(h),
        channels(c),
        stride(w * c + random_int(random, 0, 3)),
        pixels(static_cast<std::size_t>(stride * (h - 1) + w * c)) {
    for (T& value : pixels) {
      if constexpr (std::is_same_v<T, float>) {
        value = static_cast<float>(random_int(random, -20, 130)) / 100;
      } else {
        value = static_cast<T>(random());
      }
    }
    for (int n = 0; n < count; ++n) {
      x_px.push_back(position(random, width, n));
      y_px.push_back(position(random, height, n));
    }
  }

  /// Mostly inside and near each other, as in real maps; at times anything.
  static float position(std::mt19937& random, int size, int n) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const float last = static_cast<float>(size - 1);
    switch (random() % 40) {
      case 0:
        return std::numeric_limits<float>::quiet_NaN();
      case 1:
        return random() % 2 == 0 ? kInfinity : -kInfinity;
      case 2:
        return -0.5F;
      case 3:
        return last + 0.5F;
      case 4:
        return std::nextafter(random() % 2 == 0 ? -0.5F : last + 0.5F, kInfinity);
      case 5:
        return -3e9F;
      case 6:
        return static_cast<float>(random_int(random, 0, size - 1));
      default: {
        const float jitter = static_cast<float>(random_int(random, 0, 999)) / 1000;
        return std::fmod(static_cast<float>(n), std::max(last, 1.0F)) + jitter;
      }
    }
  }

  [[nodiscard]] RemapRow<T> row() const {
    return {.pixels = pixels.data(),
            .stride = stride,
            .width = width,
            .height = height,
            .channels = channels,
            .x_px = x_px.data(),
            .y_px = y_px.data(),
            .count = static_cast<int>(x_px.size())};
  }
};

template <typename T>
class BicubicRemap : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, std::uint16_t, float>;
TYPED_TEST_SUITE(BicubicRemap, PixelTypes);

TYPED_TEST(BicubicRemap, EqualOnEveryInstructionSet) {
  using T = TypeParam;
  std::mt19937 random(1);
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 2}, {3, 5}, {4, 4}, {5, 7}, {13, 11}, {150, 6}}) {
    for (const int channels : {1, 3, 4}) {
      for (const int count : {0, 1, 5, 63, 64, 65, 149, 200}) {
        const Scene<T> scene(random, width, height, channels, count);
        const std::size_t size = static_cast<std::size_t>(count * channels);
        SCOPED_TRACE(testing::Message()
                     << width << "x" << height << ", " << channels << " channels");
        row_on_every_target<T>(size, [&](T* out) { remap_bicubic_row(scene.row(), out); });
      }
    }
  }
}

// Blocks all of whose taps lie inside take another path than those at the border; it reads more
// than it needs and must not do so behind the image.
TYPED_TEST(BicubicRemap, ReadsNothingBehindTheImage) {
  using T = TypeParam;
  std::mt19937 random(2);
  for (const int channels : {1, 3, 4}) {
    for (int from_right = 2; from_right <= 6; ++from_right) {
      Scene<T> scene(random, 96, 4, channels, 64);
      for (int n = 0; n < 64; ++n) {
        scene.x_px[n] = 95.25F - static_cast<float>(from_right);
        scene.y_px[n] = 1.5F;
      }
      SCOPED_TRACE(testing::Message() << channels << " channels, " << from_right);
      row_on_every_target<T>(64 * channels, [&](T* out) { remap_bicubic_row(scene.row(), out); });
    }
  }
}

TYPED_TEST(BicubicRemap, IsKeysConvolutionWithReplicatedBorder) {
  using T = TypeParam;
  std::mt19937 random(3);
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 7}, {7, 2}, {30, 20}}) {
    for (const int channels : {1, 3, 4}) {
      const Scene<T> scene(random, width, height, channels, 150);
      std::vector<T> result(150 * channels);
      remap_bicubic_row(scene.row(), result.data());
      for (int n = 0; n < 150; ++n) {
        const double x = scene.x_px[n];
        const double y = scene.y_px[n];
        const bool seen = x >= -0.5 && x <= width - 0.5 && y >= -0.5 && y <= height - 0.5;
        for (int c = 0; c < channels; ++c) {
          double sum = 0;
          double min = 0;
          double max = kLargestValue<T>;
          for (int j = -2; seen && j <= height + 2; ++j) {
            for (int i = -2; i <= width + 2; ++i) {
              const double weight = keys(x - i) * keys(y - j);
              const double value =
                  static_cast<double>(scene.pixels[std::clamp(j, 0, height - 1) * scene.stride +
                                                   std::clamp(i, 0, width - 1) * channels + c]);
              sum += weight * value;
              if (std::abs(x - i) < 2 && std::abs(y - j) < 2) {
                min = std::min(min, value);
                max = std::max(max, value);
              }
            }
          }
          const double tolerance = std::is_same_v<T, float> ? 2e-6 : 0.5 + kLargestValue<T> * 1e-6;
          ASSERT_NEAR(result[n * channels + c], std::clamp(sum, min, max), tolerance)
              << width << "x" << height << " at " << x << ", " << y;
        }
      }
    }
  }
}

TYPED_TEST(BicubicRemap, WholePositionsAreThePixelsThemselves) {
  using T = TypeParam;
  std::mt19937 random(4);
  for (const int channels : {1, 3, 4}) {
    Scene<T> scene(random, 70, 5, channels, 70);
    for (int y = 0; y < 5; ++y) {
      for (int n = 0; n < 70; ++n) {
        scene.x_px[n] = static_cast<float>(n);
        scene.y_px[n] = static_cast<float>(y);
      }
      std::vector<T> result(70 * channels);
      remap_bicubic_row(scene.row(), result.data());
      const auto first = scene.pixels.begin() + y * scene.stride;
      EXPECT_EQ(result, std::vector<T>(first, first + 70 * channels)) << "row " << y;
    }
  }
}

}  // namespace vantage::kernels::bicubic_remap_test
