#include "engine/synthesis/view_sampling.h"

#include <Eigen/Geometry>

#include "engine/synthesis/view_synthesizer.h"
#include "tests/engine/engine_test.h"

namespace vantage::view_sampling_test {

DisparityMap flat_map(int width, int height, float d) {
  DisparityMap map(width, height);
  map.fill(d);
  return map;
}

/// From the left camera's place and in its direction; `across`: another focal length along x.
NewView zoomed(int width, int height, double zoom, double across = 1, double back = 0) {
  RectifiedPair pair;
  pair.width_px = width;
  pair.height_px = height;
  pair.left.matrix << 200, 0, (width - 1) / 2.0, 0, 200, (height - 1) / 2.0, 0, 0, 1;
  pair.right = pair.left;
  pair.baseline = 1;
  PosedCamera camera;
  camera.matrix = pair.left.matrix;
  camera.matrix(0, 0) *= zoom * across;
  camera.matrix(1, 1) *= zoom;
  camera.translation.z() = back;
  camera.width_px = width;
  camera.height_px = height;
  return camera_view(pair, camera);
}

ViewSampling sampling_of(const NewView& view, float d = 8) {
  const DisparityMap map = flat_map(160, 120, d);
  return view_sampling(view, map.view(), map.view());
}

TEST(ViewSampling, HasAsManySamplesAsTheViewReduces) {
  EXPECT_EQ(sampling_of(baseline_view(0.5, -0.7, 160, 120)).samples, 1);
  for (const auto& [zoom, samples] : {std::pair{3.0, 1},
                                      {1.0, 1},
                                      {0.9, 1},
                                      {0.75, 2},
                                      {0.5, 2},
                                      {0.4, 3},
                                      {0.25, 4},
                                      {0.01, 8}}) {
    const NewView view = zoomed(160, 120, zoom);
    EXPECT_EQ(sampling_of(view).samples, samples) << zoom;
    EXPECT_NEAR(sampling_of(view).reduction, samples == 1 ? 1 : 1 / zoom, 1e-6);
    EXPECT_GE(max_samples_per_side(view, 160, 120), samples);
  }
  // The direction in which it reduces most counts.
  EXPECT_NEAR(sampling_of(zoomed(160, 120, 1, 0.5)).reduction, 2, 1e-6);
  // A camera further back reduces what is near: at d = 8, 25 baselines away, by half again.
  EXPECT_NEAR(sampling_of(zoomed(160, 120, 1, 1, 12.5)).reduction, 1.5, 1e-6);
  EXPECT_NEAR(sampling_of(zoomed(160, 120, 1, 1, 12.5), 0).reduction, 1, 1e-6);
  // Nothing known, nothing seen.
  const NewView half = zoomed(160, 120, 0.5);
  EXPECT_EQ(sampling_of(half, std::numeric_limits<float>::quiet_NaN()).samples, 1);
  NewView elsewhere = half;
  elsewhere.from_left.homography.col(2).x() += 1e6;
  elsewhere.from_right.homography.col(2).x() += 1e6;
  EXPECT_EQ(sampling_of(elsewhere).samples, 1);
  NewView broken = half;
  broken.from_left.homography(0, 1) = std::nan("");
  broken.from_right.homography.setZero();
  EXPECT_EQ(sampling_of(broken).samples, 1);
}

TEST(ViewSampling, SamplesLieInTheirPixels) {
  const NewView view = zoomed(160, 120, 0.5);
  const NewView fine = with_samples(view, 3);
  EXPECT_EQ(fine.width_px, 480);
  EXPECT_EQ(fine.height_px, 360);
  const Eigen::Vector3d point(30, 50, 1);
  for (const auto& [coarse_warp, fine_warp] :
       {std::pair{view.from_left, fine.from_left}, {view.from_right, fine.from_right}}) {
    const Eigen::Vector2d coarse =
        (coarse_warp.homography * point + 7 * coarse_warp.parallax).hnormalized();
    const Eigen::Vector2d sample =
        (fine_warp.homography * point + 7 * fine_warp.parallax).hnormalized();
    // Pixel (0, 0) has the samples 0, 1, 2: its centre is the second.
    EXPECT_NEAR(sample.x(), 3 * coarse.x() + 1, 1e-9);
    EXPECT_NEAR(sample.y(), 3 * coarse.y() + 1, 1e-9);
  }
}

template <typename T>
SynthesizedView random_view(std::mt19937& random, int width, int height, int channels) {
  Image<T> image(width, height, channels);
  SynthesizedView view;
  view.holes.resize(width, height);
  view.sources.resize(width, height);
  for (int y = 0; y < height; ++y) {
    for (int k = 0; k < width * channels; ++k) {
      image.row(y)[k] = static_cast<T>(static_cast<double>(random() % 256) /
                                       static_cast<double>(kGreyLevelsPerUnit<T>));
    }
    for (int x = 0; x < width; ++x) {
      view.sources.at(x, y) = static_cast<std::uint8_t>(85 * (random() % 4));
      view.holes.at(x, y) = view.sources.at(x, y) == 0 ? 255 : 0;
    }
  }
  view.image.pixels = std::move(image);
  view.intensity[0] = {3, 0.5};
  return view;
}

// In doubles, from what the weights are for: their sum is 1 and the places of the samples have the
// variance that is missing.
std::vector<double> plain_weights(const ViewSampling& sampling) {
  const int n = sampling.samples + 2;
  const double distance = sampling.reduction / sampling.samples;
  const auto variance = [&](const std::vector<double>& weights) {
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double place = (i - (n - 1) / 2.0) * distance;
      sum += weights[static_cast<std::size_t>(i)] * place * place;
    }
    return sum;
  };
  std::vector<double> only_own(static_cast<std::size_t>(n), 1.0 / sampling.samples);
  only_own.front() = only_own.back() = 0;
  std::vector<double> only_outer(static_cast<std::size_t>(n), 0.0);
  only_outer.front() = only_outer.back() = 0.5;
  const double wanted = (sampling.reduction * sampling.reduction - 1) / 12;
  const double share = (wanted - variance(only_own)) / (variance(only_outer) - variance(only_own));
  std::vector<double> weights(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = (1 - share) * only_own[i] + share * only_outer[i];
  }
  return weights;
}

template <typename T>
void expect_plain_means(int channels, const ViewSampling& sampling) {
  std::mt19937 random(7);
  const int width = 9;
  const int height = 5;
  const int samples = sampling.samples;
  const SynthesizedView fine = random_view<T>(random, samples * width, samples * height, channels);
  const auto& fine_image = std::get<Image<T>>(fine.image.pixels);
  SynthesizedView view;
  reduce_view(fine, sampling, view, execution());
  const auto& image = std::get<Image<T>>(view.image.pixels);
  ASSERT_EQ(image.width(), width);
  ASSERT_EQ(image.height(), height);
  EXPECT_EQ(view.intensity[0].offset, 3);
  const std::vector<double> weights = plain_weights(sampling);
  const double unit = 255 / static_cast<double>(kGreyLevelsPerUnit<T>);
  int holes = 0;
  for (const auto [x, y] : positions_of(width, height)) {
    int sources = 0;
    for (int k = 0; k < samples * samples; ++k) {
      sources |= fine.sources.at(samples * x + k % samples, samples * y + k / samples);
    }
    EXPECT_EQ(view.sources.at(x, y), sources);
    EXPECT_EQ(view.holes.at(x, y), sources == 0 ? 255 : 0);
    holes += sources == 0 ? 1 : 0;
    for (int c = 0; c < channels; ++c) {
      double sum = 0;
      for (int j = -1; j <= samples; ++j) {
        for (int i = -1; i <= samples; ++i) {
          const int column = std::clamp(samples * x + i, 0, fine_image.width() - 1);
          const int line = std::clamp(samples * y + j, 0, fine_image.height() - 1);
          sum += weights[static_cast<std::size_t>(i + 1)] *
                 weights[static_cast<std::size_t>(j + 1)] *
                 static_cast<double>(fine_image.at(column, line, c));
        }
      }
      if (std::is_integral_v<T>) {
        sum = std::clamp(sum, 0.0, unit);
      }
      EXPECT_NEAR(static_cast<double>(image.at(x, y, c)), sum, std::is_integral_v<T> ? 0.51 : 1e-5);
    }
  }
  EXPECT_DOUBLE_EQ(view.hole_fraction, holes / 45.0);
}

TEST(ViewSampling, ReducesToMeansOfTheRightWidth) {
  expect_plain_means<std::uint8_t>(3, {.samples = 2, .reduction = 1.3});
  expect_plain_means<std::uint8_t>(1, {.samples = 2, .reduction = 2});
  expect_plain_means<std::uint16_t>(4, {.samples = 3, .reduction = 2.6});
  expect_plain_means<float>(3, {.samples = 8, .reduction = 30});
}

// Stripes too fine for the view become grey, not stripes of another width.
TEST(ViewSampling, FineStripesDoNotAlias) {
  const int width = 160;
  const int height = 40;
  Image<std::uint8_t> stripes(width, height, 1);
  for (const auto [x, y] : positions_of(width, height)) {
    stripes.at(x, y) = static_cast<std::uint8_t>(
        std::lround(128 + 100 * std::cos(2 * std::numbers::pi * 0.47 * x)));
  }
  const Photograph photograph{std::move(stripes)};
  const DisparityMap map = flat_map(width, height, 4);
  SynthesizedView view;
  ViewSynthesizer({}, execution())
      .synthesize({photograph, photograph, map.view(), map.view()}, zoomed(width, height, 0.5),
                  view);
  const auto& image = std::get<Image<std::uint8_t>>(view.image.pixels);
  for (int x = width / 4 + 4; x < 3 * width / 4 - 4; ++x) {
    EXPECT_NEAR(image.at(x, height / 2), 128, 14) << x;  // a sample per pixel: 28 to 228
  }
}

}  // namespace vantage::view_sampling_test
