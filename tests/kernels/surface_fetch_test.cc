#include "kernels/surface_fetch/surface_fetch.h"

#include <type_traits>

#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/pixel_row/pixel_row.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/plain_taps.h"
#include "tests/kernels/projection_cases.h"
#include "tests/keys_kernel.h"

namespace vantage::kernels::surface_fetch_test {

using test::keys;

/// An image with its map, both ending where their memory ends, and positions in it.
template <typename T>
struct Scene {
  int width;
  int height;
  int channels;
  std::ptrdiff_t stride;
  std::vector<T> pixels;
  std::vector<float> map;
  std::vector<std::int32_t> column, line;
  std::vector<float> fraction_x, fraction_y, disparity_px;

  Scene(std::mt19937& random, int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        stride(w * c + random_int(random, 0, 3)),
        pixels(static_cast<std::size_t>(stride * (h - 1) + w * c)),
        map(random_map(random, w, h)) {
    for (T& value : pixels) {
      if constexpr (std::is_same_v<T, float>) {
        value = static_cast<float>(random_int(random, -20, 130)) / 100;
      } else {
        value = static_cast<T>(random());
      }
    }
  }

  [[nodiscard]] T pixel(int x, int y, int c) const { return pixels[y * stride + x * channels + c]; }
  [[nodiscard]] float at(int x, int y) const { return map[y * width + x]; }

  void add(double x, double y, float d) {
    column.push_back(static_cast<std::int32_t>(std::floor(x)));
    line.push_back(static_cast<std::int32_t>(std::floor(y)));
    fraction_x.push_back(static_cast<float>(x - std::floor(x)));
    fraction_y.push_back(static_cast<float>(y - std::floor(y)));
    disparity_px.push_back(d);
  }

  /// Positions whose disparity is mostly that of a pixel near them, as in a warped row.
  void add_random(std::mt19937& random, int count) {
    for (int n = 0; n < count; ++n) {
      const double x = std::min(random_int(random, -8, 8 * width) / 8.0, width - 0.5);
      const double y = std::min(random_int(random, -8, 8 * height) / 8.0, height - 0.5);
      const float near = at(std::clamp(static_cast<int>(x), 0, width - 1),
                            std::clamp(static_cast<int>(y), 0, height - 1));
      add(x, y, random() % 6 == 0 ? near + 1.5F : near);
    }
  }

  [[nodiscard]] SurfaceFetchRow<T> row(float limit) const {
    return {.pixels = pixels.data(),
            .stride = stride,
            .map_px = map.data(),
            .map_stride = width,
            .width = width,
            .height = height,
            .channels = channels,
            .column = column.data(),
            .line = line.data(),
            .fraction_x = fraction_x.data(),
            .fraction_y = fraction_y.data(),
            .disparity_px = disparity_px.data(),
            .count = static_cast<int>(column.size()),
            .gradient_limit_px = limit};
  }
  [[nodiscard]] std::size_t values() const {
    return column.size() * static_cast<std::size_t>(pixel_lanes(channels));
  }
};

template <typename T>
class SurfaceFetch : public testing::Test {};
using PixelTypes = testing::Types<std::uint8_t, std::uint16_t, float>;
TYPED_TEST_SUITE(SurfaceFetch, PixelTypes);

/// The contract in double, of position n.
template <typename T>
double plain_colour(const Scene<T>& scene, std::size_t n, int c, float limit) {
  const float d = scene.disparity_px[n];
  if (std::isnan(d) || c >= scene.channels) {
    return 0;
  }
  const int first_column = scene.column[n] - 1;
  const int first_line = scene.line[n] - 1;
  PlainTaps columns[4];  // in each row
  bool row_on_surface[4];
  for (int j = 0; j < 4; ++j) {
    bool on_surface[4];
    for (int i = 0; i < 4; ++i) {
      const int x = first_column + i;
      const int y = first_line + j;
      on_surface[i] = x >= 0 && x < scene.width && y >= 0 && y < scene.height &&
                      std::abs(scene.at(x, y) - d) <= limit;
    }
    columns[j] = plain_taps(on_surface, first_column, scene.width, scene.fraction_x[n]);
    row_on_surface[j] = columns[j].is_on_surface;
  }
  const PlainTaps lines = plain_taps(row_on_surface, first_line, scene.height, scene.fraction_y[n]);
  double sum = 0;
  double min = 0;
  double max = kLargestValue<T>;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const int line = lines.from[j];
      const double value = static_cast<double>(
          scene.pixel(first_column + columns[line].from[i], first_line + line, c));
      sum += keys(1.0 - i + scene.fraction_x[n]) * keys(1.0 - j + scene.fraction_y[n]) * value;
      min = std::min(min, value);
      max = std::max(max, value);
    }
  }
  return std::clamp(sum, min, max);
}

/// On every instruction set.
template <typename T>
void expect_plain_colours(const Scene<T>& scene, float limit) {
  const auto colours = row_on_every_target<float>(
      scene.values(), [&](float* out) { fetch_surface_row(scene.row(limit), out); });
  const int lanes = pixel_lanes(scene.channels);
  for (std::size_t n = 0; n < scene.column.size(); ++n) {
    for (int c = 0; c < lanes; ++c) {
      ASSERT_NEAR(colours[n * lanes + c], plain_colour(scene, n, c, limit), kLargestValue<T> * 2e-6)
          << scene.width << "x" << scene.height << ", " << scene.channels << " channels, position "
          << n;
    }
  }
}

TYPED_TEST(SurfaceFetch, IsTheDefinition) {
  using T = TypeParam;
  std::mt19937 random(1);
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 2}, {3, 5}, {4, 4}, {5, 7}, {13, 11}, {150, 9}}) {
    for (const int channels : {1, 3, 4}) {
      for (const int count : {0, 1, 5, 63, 64, 65, 200}) {
        Scene<T> scene(random, width, height, channels);
        scene.add_random(random, count);
        for (const float limit : {0.0F, 1.0F, 100.0F}) {
          expect_plain_colours(scene, limit);
        }
      }
    }
  }
}

// It reads more than it needs inside the image, and must not do so behind it.
TYPED_TEST(SurfaceFetch, ReadsNothingBehindTheImage) {
  std::mt19937 random(2);
  for (const int channels : {1, 3, 4}) {
    for (int from_right = 1; from_right <= 6; ++from_right) {
      Scene<TypeParam> scene(random, 96, 4, channels);
      std::fill(scene.map.begin(), scene.map.end(), 5.0F);
      for (int n = 0; n < 64; ++n) {
        scene.add(95.25 - from_right, 1.5, 5);
      }
      expect_plain_colours(scene, 1);
    }
  }
}

// Along one row it is the fetch of views on the baseline, jumps and borders included.
TYPED_TEST(SurfaceFetch, InOneRowIsTheFetchAlongIt) {
  using T = TypeParam;
  std::mt19937 random(4);
  for (const int width : {1, 3, 8, 65, 130}) {
    for (const int channels : {1, 3, 4}) {
      const int height = 5;
      Scene<T> scene(random, width, height, channels);
      if constexpr (std::is_same_v<T, float>) {
        for (T& value : scene.pixels) {
          value = std::clamp(value, 0.0F, 1.0F);
        }
      }
      const int y = random_int(random, 0, height - 1);
      const PlanesWithMargins pixels(scene.pixels.data() + y * scene.stride, width, channels);
      const float* map_row = scene.map.data() + y * width;
      const RowWithMargins map(std::vector<float>(map_row, map_row + width), kUnknownDisparity);
      const double s = 0.37;
      std::vector<float> warped(width);
      for (int n = 0; n < width; ++n) {
        // A disparity that one of the two pixels around the position has.
        const float d = scene.at(std::clamp(n + random_int(random, -1, 1), 0, width - 1), y);
        const double x = std::clamp(n + s * d, -1.0, width - 0.5);
        const auto seen = [&](double column) {
          return column >= 0 && column < width &&
                 std::abs(scene.at(static_cast<int>(column), y) - d) <= 1;
        };
        const bool is_on = seen(std::floor(x)) || seen(std::floor(x) + 1);
        warped[n] = is_on ? d : kUnknownDisparity;
        scene.add(x, y, warped[n]);
      }
      std::vector<float> expected(scene.values());
      fetch_bicubic_row({.pixels = pixels.row(),
                         .stride = pixels.stride(),
                         .source_disparity_px = map.row(),
                         .warped_disparity_px = warped.data(),
                         .width = width,
                         .channels = channels,
                         .camera_offset = s,
                         .gradient_limit_px = 1,
                         .largest_value = kLargestValue<T>},
                        expected.data());
      std::vector<float> result(scene.values());
      fetch_surface_row(scene.row(1), result.data());
      ASSERT_EQ(result, expected) << width << " wide, " << channels << " channels";
    }
  }
}

// A disc of 200 at d = 8 before 50 at d = 0: only these two colours may appear.
TEST(SurfaceFetchColours, DoesNotMixSurfaces) {
  std::mt19937 random(5);
  Scene<std::uint8_t> scene(random, 40, 30, 3);
  const auto is_front = [](double x, double y) { return std::hypot(x - 20, y - 15) < 8; };
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      scene.map[y * 40 + x] = is_front(x, y) ? 8.0F : 0.0F;
      for (int c = 0; c < 3; ++c) {
        scene.pixels[y * scene.stride + x * 3 + c] = is_front(x, y) ? 200 : 50;
      }
    }
  }
  for (int y = 0; y < 30 * 4 - 4; ++y) {
    for (int x = 0; x < 40 * 4 - 4; ++x) {
      // The disparity of the nearest pixel.
      const bool front = is_front(std::floor(x / 4.0 + 0.5), std::floor(y / 4.0 + 0.5));
      scene.add(x / 4.0, y / 4.0, front ? 8.0F : 0.0F);
    }
  }
  std::vector<float> result(scene.values());
  fetch_surface_row(scene.row(1), result.data());
  for (std::size_t n = 0; n < scene.column.size(); ++n) {
    ASSERT_NEAR(result[4 * n], scene.disparity_px[n] > 4 ? 200.0F : 50.0F, 1e-3F) << n;
    ASSERT_EQ(result[4 * n + 3], 0.0F);
  }
}

}  // namespace vantage::kernels::surface_fetch_test
