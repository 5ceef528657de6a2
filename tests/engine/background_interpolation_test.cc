#include "engine/synthesis/background_interpolation.h"

#include "kernels/pixel_row/pixel_row.h"
#include "tests/engine/engine_test.h"

namespace vantage::background_interpolation_test {

/// Noise with blocks, streaks, rows and single pixels to be filled, before two surfaces.
template <typename T>
struct Scene {
  Image<T> image;
  Mask wanted;
  DisparityMap disparity_px;

  Scene(int width, int height, int channels, unsigned seed)
      : image(width, height, channels), wanted(width, height), disparity_px(width, height) {
    std::mt19937 random(seed);
    for (const auto [k, y] : positions_of(width * channels, height)) {
      image.row(y)[k] =
          static_cast<T>(kernels::kLargestValue<T> * static_cast<float>(random() % 251) / 255);
    }
    for (const auto [x, y] : positions_of(width, height)) {
      const bool is_near = (x / 23 + y / 17) % 2 == 0;
      disparity_px.at(x, y) = (is_near ? 9.0F : 2.0F) + 0.03F * static_cast<float>(y);
      const bool is_block = x / 11 % 3 == 0 && y / 7 % 2 == 0;
      wanted.at(x, y) = is_block || y == 5 || (y == 20 && x < 150) || random() % 16 == 0 ? 255 : 0;
    }
  }
  [[nodiscard]] std::vector<HoleRow> rows() const {
    std::vector<HoleRow> rows;
    for (int y = 0; y < image.height(); ++y) {
      rows.push_back({wanted.row(y), disparity_px.row(y)});
    }
    return rows;
  }
  [[nodiscard]] bool has(int x, int y) const {
    return x >= 0 && x < image.width() && y >= 0 && y < image.height();
  }
  [[nodiscard]] bool fills(int x, int y) const { return has(x, y) && wanted.at(x, y) != 0; }

  /// The next pixel in a direction that is not to be filled; NaN: there is none within `reach`.
  [[nodiscard]] double beside(int x, int y, int dx, int dy, int reach) const {
    for (int k = 1; k <= reach && has(x + k * dx, y + k * dy); ++k) {
      if (!fills(x + k * dx, y + k * dy)) {
        return disparity_px.at(x + k * dx, y + k * dy);
      }
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] double columns(int x, int y) const {
    return std::fmin(beside(x, y, 0, -1, 16), beside(x, y, 0, 1, 16));
  }
};

/// Straight from the definition, in double; NaN: unchanged.
template <typename T>
std::vector<double> plain_mean(const Scene<T>& scene, int x, int y) {
  const int channels = scene.image.channels();
  int begin = x;
  int end = x + 1;
  for (; scene.fills(begin - 1, y); --begin) {
  }
  for (; scene.fills(end, y); ++end) {
  }
  std::vector<double> sums(static_cast<std::size_t>(channels), 0);
  double weights = 0;
  if (begin == 0 && end == scene.image.width()) {
    return {};
  }
  double above_below = -1e30;
  for (int column = std::max(x - 1, begin); column <= std::min(x + 1, end - 1); ++column) {
    const double farther = scene.columns(column, y);
    above_below = std::max(above_below, std::isnan(farther) ? 1e30 : farther);
  }
  const double background = std::fmin(
      above_below, std::fmin(scene.beside(x, y, -1, 0, 1000), scene.beside(x, y, 1, 0, 1000)));
  for (const int offset : {-16, -8, -4, -2, -1, 0, 1, 2, 4, 8, 16}) {
    const int row = y + offset;
    if (!scene.has(x, row) || std::abs(offset) > 4 * (end - begin)) {
      continue;
    }
    std::set<int> samples;
    for (const int step : {-1, 1}) {
      int from = x;
      for (; scene.fills(from, row); from += step) {
      }
      if (scene.has(from, row) && from >= begin - 64 && from < end + 64) {
        samples.insert(from);
      }
    }
    for (const int from : samples) {
      const double distance2 = (from - x) * (from - x) + offset * offset;
      const double weight = (std::abs(offset) < 2 ? 1 : 0.75 * std::abs(offset)) / distance2;
      if (scene.disparity_px.at(from, row) - background <= 1) {
        weights += weight;
        for (int c = 0; c < channels; ++c) {
          sums[static_cast<std::size_t>(c)] += weight * scene.image.at(from, row, c);
        }
      }
    }
  }
  for (double& sum : sums) {
    sum /= weights;
  }
  return weights > 0 ? sums : std::vector<double>();
}

template <typename T>
class BackgroundInterpolation : public testing::Test {};
TYPED_TEST_SUITE(BackgroundInterpolation, PixelTypes);

TYPED_TEST(BackgroundInterpolation, EqualsItsDefinition) {
  using T = TypeParam;
  for (const auto [width, height, channels] :
       {std::array{190, 37, 3}, {41, 40, 1}, {1, 19, 4}, {67, 1, 1}}) {
    const Scene<T> scene(width, height, channels, 7);
    Image<T> filled = Scene<T>(width, height, channels, 7).image;
    interpolate_background(filled.view(), scene.rows(), 0, height, 1, execution());
    for (const auto [x, y] : positions_of(width, height)) {
      const std::vector<double> mean =
          scene.fills(x, y) ? plain_mean(scene, x, y) : std::vector<double>();
      for (int c = 0; c < channels; ++c) {
        const double expected =
            mean.empty() ? scene.image.at(x, y, c) : mean[static_cast<std::size_t>(c)];
        ASSERT_NEAR(filled.at(x, y, c), expected,
                    std::is_integral_v<T> && !mean.empty() ? 0.51 : 1e-5)
            << x << ", " << y;
      }
    }
  }
}

// One disparity beyond the background must not leave its pixel as the only sample.
TEST(BackgroundInterpolation, NoSinglePixelDecides) {
  Scene<std::uint8_t> scene(30, 12, 1, 3);
  scene.wanted.fill(0);
  scene.disparity_px.fill(5);
  scene.image.fill(80);
  for (const auto [x, y] : positions_of(8, 5)) {
    scene.wanted.at(10 + x, 4 + y) = 255;
  }
  scene.disparity_px.at(13, 3) = 0;
  scene.image.at(13, 3) = 255;
  interpolate_background(scene.image.view(), scene.rows(), 0, 12, 1, execution());
  for (const auto [x, y] : positions_of(8, 5)) {
    EXPECT_LT(scene.image.at(10 + x, 4 + y), 200) << x << ", " << y;
  }
}

}  // namespace vantage::background_interpolation_test
