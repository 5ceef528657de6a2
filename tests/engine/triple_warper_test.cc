#include "engine/synthesis/triple_warper.h"

#include "engine/synthesis/view_synthesizer.h"
#include "tests/engine/engine_test.h"

namespace vantage::triple_warper_test {

ViewWarp translation(double x, double y) {
  ViewWarp warp;
  warp.parallax = {x, y, 0};
  return warp;
}

DisparityMap random_map(std::mt19937& random, int width, int height) {
  DisparityMap map(width, height);
  for (int y = 0; y < height; ++y) {
    float d = 2;
    for (int x = 0; x < width; ++x) {
      const auto event = random() % 10;
      d = event == 0 ? static_cast<float>(random() % 24) / 4 : d;
      map.at(x, y) = event == 1 ? kUnknown : d;
    }
  }
  return map;
}

DisparityMap constant_map(int width, int height, float value) {
  DisparityMap map(width, height);
  map.fill(value);
  return map;
}

template <typename T>
class Triple : public testing::Test {};
TYPED_TEST_SUITE(Triple, PixelTypes);

// Whichever of the three shows nothing, the others make the view as a pair does.
TYPED_TEST(Triple, WithoutOneImageIsThePairOfTheOthers) {
  constexpr int kSizes[][2] = {{1, 1}, {1, 13}, {17, 1}, {37, 11}};
  std::mt19937 random(4);
  SynthesisOptions options;
  options.gamma.reset();
  options.match_intensities = false;
  options.soft_edges = false;
  const ViewSynthesizer synthesizer(options, execution());
  for (const auto& [width, height] : kSizes) {
    for (const int channels : {1, 3, 4}) {
      const Photograph first = noise<TypeParam>(width, height, channels, 1);
      const Photograph second = noise<TypeParam>(width, height, channels, 2);
      const DisparityMap first_px = random_map(random, width, height);
      const DisparityMap second_px = random_map(random, width, height);
      const DisparityMap nothing = constant_map(width, height, kUnknown);
      NewView pair;
      pair.width_px = width;
      pair.height_px = height;
      pair.from_left = translation(-0.4, 0.3);
      pair.from_right = translation(0.2, -0.7);
      pair.distance_from_left = 1;
      pair.distance_from_right = 3;
      SynthesizedView expected;
      synthesizer.synthesize({first, second, first_px.view(), second_px.view()}, pair, expected);
      for (std::size_t empty = 0; empty < 3; ++empty) {
        const std::size_t left = empty == 0 ? 1 : 0;
        const std::size_t right = empty == 2 ? 1 : 2;
        PhotographTriple triple;
        TripleView view;
        view.width_px = width;
        view.height_px = height;
        triple.images[left] = &first;
        triple.images[right] = &second;
        triple.images[empty] = &first;
        triple.disparity_px[left] = first_px.view();
        triple.disparity_px[right] = second_px.view();
        triple.disparity_px[empty] = nothing.view();
        view.from[left] = pair.from_left;
        view.from[right] = pair.from_right;
        view.weights[left] = 0.75;
        view.weights[right] = 0.25;
        view.weights[empty] = 0;
        SynthesizedView made;
        synthesizer.synthesize(triple, view, made, {});
        EXPECT_TRUE(same(made.image, expected.image))
            << width << "×" << height << ", " << channels << " channels, without " << empty;
        EXPECT_EQ(made.hole_fraction, expected.hole_fraction);
      }
    }
  }
}

/// One grey image of one value at one disparity.
struct Plane {
  Photograph image;
  DisparityMap disparity_px;

  Plane(std::uint8_t value, float disparity) : disparity_px(constant_map(5, 4, disparity)) {
    Image<std::uint8_t> pixels(5, 4);
    pixels.fill(value);
    image.pixels = std::move(pixels);
  }
};

int centre_of(const std::vector<Plane>& planes, std::array<double, 3> weights,
              const TripleFit& fit = {}) {
  PhotographTriple triple;
  TripleView view;
  view.width_px = 5;
  view.height_px = 4;
  view.weights = weights;
  for (std::size_t k = 0; k < 3; ++k) {
    triple.images[k] = &planes[k].image;
    triple.disparity_px[k] = planes[k].disparity_px.view();
  }
  SynthesizedView result;
  ViewSynthesizer({}, execution()).synthesize(triple, view, result, fit);
  return std::get<Image<std::uint8_t>>(result.image.pixels).at(2, 2);
}

TEST(TripleView, OneSurfaceIsTheWeightedMean) {
  std::vector<Plane> planes;
  planes.emplace_back(100, 3.0F);
  planes.emplace_back(180, 3.4F);
  planes.emplace_back(40, 2.8F);
  EXPECT_EQ(centre_of(planes, {0.5, 0.3, 0.2}), 112);
  EXPECT_EQ(centre_of(planes, {0, 0.5, 0.5}), 110);
  EXPECT_EQ(centre_of(planes, {0, 0, 1}), 40);
  EXPECT_EQ(centre_of(planes, {0, 1, 0}), 180);
}

TEST(TripleView, OfDifferentSurfacesTheNearerOneStays) {
  std::vector<Plane> planes;
  planes.emplace_back(100, 3.0F);
  planes.emplace_back(180, 9.0F);
  planes.emplace_back(40, 3.0F);
  EXPECT_EQ(centre_of(planes, {0.5, 0.25, 0.25}), 180);
  planes[1].disparity_px.fill(0);
  EXPECT_EQ(centre_of(planes, {0.5, 0.25, 0.25}), 85);  // 100 · ¾ + 40 · ¼
}

TEST(TripleView, IntensitiesMoveWithTheWeights) {
  std::vector<Plane> planes;
  planes.emplace_back(100, 3.0F);
  planes.emplace_back(60, 3.0F);   // ½ · 100 + 10
  planes.emplace_back(200, 3.0F);  // 2 · 80 + 40, of what the first two are together
  TripleFit fit;
  fit.second_on_first.fill({.offset = 10, .gain = 0.5});
  fit.third_on_others.fill({.offset = 40, .gain = 2});
  EXPECT_EQ(centre_of(planes, {1, 0, 0}, fit), 100);
  EXPECT_EQ(centre_of(planes, {0, 1, 0}, fit), 60);
  EXPECT_EQ(centre_of(planes, {0, 0, 1}, fit), 200);
  EXPECT_EQ(centre_of(planes, {0.25, 0.25, 0.5}, fit), 140);
  // Seen by the second alone, with the brightness of the place: (1 · 100 + 1 · 60) / 2.
  planes[0].disparity_px.fill(kUnknown);
  planes[2].disparity_px.fill(kUnknown);
  EXPECT_EQ(centre_of(planes, {0.5, 0.5, 0}, fit), 80);
}

TEST(TripleView, RefusesImagesThatDoNotGoTogether) {
  std::vector<Plane> planes;
  for (int k = 0; k < 3; ++k) {
    planes.emplace_back(100, 3.0F);
  }
  planes[2].disparity_px = constant_map(5, 3, 1);
  EXPECT_THAT(error_of([&] { centre_of(planes, {1, 0, 0}); }), HasSubstr("5×3, expected 5×4"));
}

}  // namespace vantage::triple_warper_test
