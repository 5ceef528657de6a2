#include "engine/synthesis/view_synthesizer.h"

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/every_execution.h"
#include "tests/engine/plain_synthesis.h"
#include "tests/engine/synthesis_pair.h"

namespace vantage::view_synthesizer_test {

DisparityMap random_map(std::mt19937& random, int width, int height) {
  DisparityMap map(width, height);
  for (int y = 0; y < height; ++y) {
    float d = 2;
    float slope = 0;
    for (int x = 0; x < width; ++x) {
      const auto event = random() % 12;
      if (event == 0) {
        d = static_cast<float>(random() % 40) / 4;
        slope = static_cast<float>(random() % 5) / 8 - 0.25F;
      }
      map.at(x, y) = event == 1 ? kUnknown : d;
      d += slope;
    }
  }
  return map;
}

using Pair = SynthesisPair;

template <typename T>
Pair random_pair(std::mt19937& random, int width, int height, int channels) {
  return random_synthesis_pair<T>(random, width, height, channels, 0.8,
                                  [&] { return random_map(random, width, height); });
}

template <typename T>
class ViewSynthesizerDepth : public testing::Test {};
TYPED_TEST_SUITE(ViewSynthesizerDepth, PixelTypes);

TYPED_TEST(ViewSynthesizerDepth, EqualsPlainTranscription) {
  constexpr int kSizes[][2] = {{1, 1}, {1, 23}, {29, 1}, {2, 3}, {37, 19}, {131, 17}};
  constexpr double kViews[] = {-0.6, 0.0, 0.37, 0.5, 1.0, 1.8};
  std::mt19937 random(21);
  int variant = 0;
  for (const auto& [width, height] : kSizes) {
    for (const int channels : {1, 3, 4}) {
      const Pair pair = random_pair<TypeParam>(random, width, height, channels);
      for (const double view_x : kViews) {
        SynthesisOptions options;
        // Not 1: interpolated disparities must not lie on the limit, where rounding decides.
        options.disparity_gradient_limit_px = 1.03;
        options.warp = variant % 2 == 0 ? WarpColour::kOnePass : WarpColour::kForward;
        options.holes = static_cast<HoleFilling>(variant % 3);
        options.gamma = variant % 5 == 0 ? std::optional<double>() : 0.25 * (variant % 5);
        options.match_intensities = variant % 4 != 0;
        options.soft_edges = false;  // view_finisher_test.cc
        ++variant;
        SynthesizedView view;
        pair.synthesize(options, view_x, execution(), view);
        const auto plain =
            plain_synthesis<TypeParam>({std::get<Image<TypeParam>>(pair.left.pixels).view(),
                                        std::get<Image<TypeParam>>(pair.right.pixels).view(),
                                        pair.left_disparity.view(), pair.right_disparity.view()},
                                       options, view_x);

        const auto& image = std::get<Image<TypeParam>>(view.image.pixels);
        const double unit = 1 / static_cast<double>(kGreyLevelsPerUnit<TypeParam>);
        const double tolerance = std::is_same_v<TypeParam, float> ? 1e-5 : 0.5 + 1e-4 * unit;
        int holes = 0;
        for (const auto [x, y] : positions_of(width, height)) {
          const bool hole = plain.hole_at(x, y);
          holes += hole ? 1 : 0;
          ASSERT_EQ(view.holes.at(x, y), hole ? 255 : 0);
          for (int c = 0; c < channels; ++c) {
            ASSERT_NEAR(static_cast<double>(image.at(x, y, c)), plain.value_at(x, y, c), tolerance)
                << width << "×" << height << ", view " << view_x << ", pixel " << x << ", " << y
                << ", variant " << variant - 1;
          }
        }
        EXPECT_DOUBLE_EQ(view.hole_fraction, static_cast<double>(holes) / (width * height));
        for (std::size_t c = 0; c < 4; ++c) {
          EXPECT_NEAR(view.intensity[c].offset, plain.intensity[c].offset, 1e-3);
          EXPECT_NEAR(view.intensity[c].gain, plain.intensity[c].gain, 1e-5);
        }
      }
    }
  }
}

TYPED_TEST(ViewSynthesizerDepth, CamerasReproduceTheirImages) {
  std::mt19937 random(22);
  for (const int channels : {1, 3, 4}) {
    const Pair pair = random_pair<TypeParam>(random, 77, 20, channels);
    for (const WarpColour warp : {WarpColour::kOnePass, WarpColour::kForward}) {
      for (const int camera : {0, 1}) {
        SynthesizedView view;
        pair.synthesize({.warp = warp, .gamma = std::nullopt}, camera, execution(), view);
        const Photograph& source = camera == 0 ? pair.left : pair.right;
        const DisparityMap& map = camera == 0 ? pair.left_disparity : pair.right_disparity;
        for (const auto [x, y] : positions_of(77, 20)) {
          for (int c = 0; c < channels && !std::isnan(map.at(x, y)); ++c) {
            ASSERT_EQ(std::get<Image<TypeParam>>(view.image.pixels).at(x, y, c),
                      std::get<Image<TypeParam>>(source.pixels).at(x, y, c));
          }
        }
      }
    }
  }
}

TEST(ViewSynthesizer, IdenticalForAnyExecutionAndInstructionSet) {
  std::mt19937 random(23);
  const Pair pair = random_pair<std::uint8_t>(random, 203, 70, 3);
  const SynthesisOptions variants[] = {
      {}, {.warp = WarpColour::kForward, .soft_edges = false}, {.holes = HoleFilling::kInpaint}};
  for (const SynthesisOptions& options : variants) {
    expect_equal_for_every_execution([&](Execution& execution) {
      SynthesizedView view;
      pair.synthesize(options, 0.4, execution, view);
      return bytes_of(view);
    });
  }
}

TEST(ViewSynthesizer, ServesSeveralThreadsAtOnce) {
  std::mt19937 random(24);
  const Pair pair = random_pair<std::uint8_t>(random, 90, 40, 3);
  const ViewSynthesizer synthesizer({}, execution());
  std::array<SynthesizedView, 4> views;
  std::vector<std::thread> threads;
  for (SynthesizedView& view : views) {
    threads.emplace_back([&] {
      synthesizer.synthesize(
          {pair.left, pair.right, pair.left_disparity.view(), pair.right_disparity.view()}, 0.5,
          view);
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const SynthesizedView& view : views) {
    EXPECT_EQ(bytes_of(view), bytes_of(views[0]));
  }
}

// The views of a scene that is known exactly: from its exact maps to the picture rendered there.
TEST(ViewSynthesizer, ExactMapsGiveTheRenderedView) {
  const LayeredScene scene({.width_px = 320, .height_px = 240, .samples_per_side = 2}, execution());
  const SceneRendering left = scene.render({0, 0}, 0);
  const SceneRendering right = scene.render({1, 0}, 0);
  for (const double view_x : {0.25, 0.5, -0.3}) {
    const SceneRendering truth = scene.render({view_x, 0}, 0);
    const Mask not_left = scene.occlusion({view_x, 0}, {0, 0}, 0);
    const Mask not_right = scene.occlusion({view_x, 0}, {1, 0}, 0);
    Mask visible(320, 240);
    for (const auto [x, y] : positions_of(320, 240)) {
      visible.at(x, y) = not_left.at(x, y) != 0 && not_right.at(x, y) != 0 ? 0 : 255;
    }
    for (const WarpColour warp : {WarpColour::kOnePass, WarpColour::kForward}) {
      SynthesizedView view;
      ViewSynthesizer({.warp = warp}, execution())
          .synthesize({left.image, right.image, left.disparity.view(), right.disparity.view()},
                      view_x, view);
      const ViewScores scores =
          evaluate_view(view.image, truth.image, execution(),
                        ImageView<const std::uint8_t>(std::as_const(visible).view()));
      EXPECT_LE(scores.mean_absolute_difference,
                warp == WarpColour::kForward && view_x < 0 ? 3.0 : 2.0)
          << "view " << view_x << ", PSNR " << scores.psnr_db;
    }
  }
}

// A right camera with its own gain and offset: regressed away, without steps at single holes.
TEST(ViewSynthesizer, FindsTheIntensityTransform) {
  std::mt19937 random(25);
  const int width = 120;
  const int height = 40;
  Image<float> left(width, height, 1);
  Image<float> right(width, height, 1);
  DisparityMap map(width, height);
  map.fill(8);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      left.at(x, y) = 0.1F + 0.6F * static_cast<float>(random() % 1000) / 1000;
    }
    for (int x = 0; x < width; ++x) {
      right.at(x, y) = 0.05F + 0.8F * left.at(std::min(x + 8, width - 1), y);
    }
  }
  SynthesizedView view;
  const Photograph left_photograph{left.copy()};
  const Photograph right_photograph{std::move(right)};
  const auto synthesize = [&](const SynthesisOptions& options) {
    ViewSynthesizer(options, execution())
        .synthesize({left_photograph, right_photograph, map.view(), map.view()}, 0.5, view);
  };
  synthesize({.gamma = 1.0});
  EXPECT_NEAR(view.intensity[0].offset, 0.05 * 255, 1e-3);
  EXPECT_NEAR(view.intensity[0].gain, 0.8, 1e-5);
  // γ = 1: everything as the left camera sees it, also where only the right one does.
  for (int x = 0; x < width - 4; ++x) {
    EXPECT_NEAR(std::get<Image<float>>(view.image.pixels).at(x, 0), left.at(x + 4, 0), 1e-5);
  }
  synthesize({.gamma = 1.0, .match_intensities = false});
  EXPECT_EQ(view.intensity[0].offset, 0);
  EXPECT_EQ(view.intensity[0].gain, 1);
}

TEST(ViewSynthesizer, AnEmptyRowTakesTheNearest) {
  Image<std::uint8_t> image(3, 6, 1);
  DisparityMap map(3, 6);
  map.fill(kUnknown);
  for (int y = 0; y < 6; ++y) {
    std::fill_n(image.row(y), 3, static_cast<std::uint8_t>(10 * y));
  }
  std::fill_n(map.row(1), 3, 0.0F);
  std::fill_n(map.row(4), 3, 0.0F);
  const Photograph photograph{std::move(image)};
  for (const HoleFilling holes : {HoleFilling::kInterpolate, HoleFilling::kMirror,
                                  HoleFilling::kSpread, HoleFilling::kNone}) {
    SynthesizedView view;
    ViewSynthesizer({.holes = holes}, execution())
        .synthesize({photograph, photograph, map.view(), map.view()}, 0.5, view);
    std::vector<int> column;
    for (int y = 0; y < 6; ++y) {
      column.push_back(std::get<Image<std::uint8_t>>(view.image.pixels).at(1, y));
      EXPECT_EQ(view.holes.at(1, y), y == 1 || y == 4 ? 0 : 255);
    }
    EXPECT_THAT(column, holes == HoleFilling::kNone ? testing::ElementsAre(0, 10, 0, 0, 40, 0)
                                                    : testing::ElementsAre(10, 10, 10, 40, 40, 40));
  }
  map.fill(kUnknown);
  SynthesizedView view;
  ViewSynthesizer({}, execution())
      .synthesize({photograph, photograph, map.view(), map.view()}, 0.5, view);
  EXPECT_EQ(view.hole_fraction, 1);
  EXPECT_EQ(std::get<Image<std::uint8_t>>(view.image.pixels).at(2, 3), 0);
}

TEST(ViewSynthesizer, RefusesWhatDoesNotFit) {
  std::mt19937 random(26);
  const Pair pair = random_pair<std::uint8_t>(random, 8, 6, 3);
  const Pair other_size = random_pair<std::uint8_t>(random, 9, 6, 3);
  const Pair grey = random_pair<std::uint8_t>(random, 8, 6, 1);
  const Pair deep = random_pair<std::uint16_t>(random, 8, 6, 3);
  const ViewSynthesizer synthesizer({}, execution());
  SynthesizedView view;
  const auto left_map = pair.left_disparity.view();
  const auto bad_map = other_size.left_disparity.view();
  const auto attempt = [&](const Photograph& right, ImageView<const float> left_disparity,
                           ImageView<const float> right_disparity, double x) {
    synthesizer.synthesize({pair.left, right, left_disparity, right_disparity}, x, view);
  };
  EXPECT_THROW(attempt(other_size.right, left_map, left_map, 0.5), Error);
  EXPECT_THROW(attempt(grey.right, left_map, left_map, 0.5), Error);
  EXPECT_THROW(attempt(deep.right, left_map, left_map, 0.5), Error);
  EXPECT_THROW(attempt(pair.right, bad_map, left_map, 0.5), Error);
  EXPECT_THROW(attempt(pair.right, left_map, bad_map, 0.5), Error);
  for (const double x : {16.1, -17.0, std::numeric_limits<double>::quiet_NaN(),
                         std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(attempt(pair.right, left_map, left_map, x), UsageError) << x;
  }
  EXPECT_THROW(ViewSynthesizer({.gamma = 1.5}, execution()), UsageError);
  EXPECT_THROW(ViewSynthesizer({.gamma = std::nan("")}, execution()), UsageError);
  EXPECT_THROW(ViewSynthesizer({.disparity_gradient_limit_px = -1}, execution()), UsageError);
  EXPECT_THROW(
      ViewSynthesizer({.disparity_gradient_limit_px = std::numeric_limits<double>::infinity()},
                      execution()),
      UsageError);
}

TEST(ViewSynthesizer, WildDisparitiesDoNoHarm) {
  std::mt19937 random(27);
  Pair pair = random_pair<float>(random, 65, 9, 3);
  const float wild[] = {1e38F,     -1e38F,
                        5000.5F,   std::numeric_limits<float>::infinity(),
                        -5000.25F, -std::numeric_limits<float>::infinity(),
                        1e-38F,    kUnknown};
  for (const auto [x, y] : positions_of(65, 9)) {
    pair.left_disparity.at(x, y) = wild[random() % 8];
    pair.right_disparity.at(x, y) = wild[random() % 8];
  }
  for (const double x : {-16.0, 0.0, 0.5, 1.0, 16.0}) {
    for (const double limit : {0.0, 1.0, 1e30}) {
      for (const WarpColour warp : {WarpColour::kOnePass, WarpColour::kForward}) {
        SynthesizedView view;
        pair.synthesize({.warp = warp, .disparity_gradient_limit_px = limit}, x, execution(), view);
        for (const auto [k, y] : positions_of(65 * 3, 9)) {
          ASSERT_TRUE(std::isfinite(std::get<Image<float>>(view.image.pixels).row(y)[k]));
        }
      }
    }
  }
}

template <typename T>
void expect_given_fits_to_act(int channels) {
  std::mt19937 random(28);
  const Pair pair = random_pair<T>(random, 67, 23, channels);
  const ViewSynthesizer synthesizer({}, execution());
  const auto synthesize = [&](const ViewSynthesizer& with, double x,
                              const std::array<IntensityFit, 4>* fit) {
    SynthesizedView view;
    with.synthesize(
        {pair.left, pair.right, pair.left_disparity.view(), pair.right_disparity.view()}, x, view,
        fit);
    return view;
  };
  for (const double x : {0.5, 0.2}) {
    const SynthesizedView own = synthesize(synthesizer, x, nullptr);
    // The same fit given is the same view.
    const SynthesizedView given = synthesize(synthesizer, x, &own.intensity);
    EXPECT_EQ(given.intensity, own.intensity);
    EXPECT_EQ(bytes_of(given), bytes_of(own));
    // Another one is another view, also of a synthesizer that does without.
    std::array<IntensityFit, 4> other = own.intensity;
    other[0].offset += 30;
    EXPECT_NE(bytes_of(synthesize(synthesizer, x, &other)), bytes_of(own));
    const ViewSynthesizer plain({.match_intensities = false}, execution());
    EXPECT_EQ(bytes_of(synthesize(plain, x, &other)), bytes_of(synthesize(synthesizer, x, &other)));
    // The sums lead to the fit.
    const kernels::IntensitySums sums = synthesizer.intensity_sums(
        {pair.left, pair.right, pair.left_disparity.view(), pair.right_disparity.view()}, x);
    EXPECT_GT(sums.pixels, 0);
    const auto fits = fit_channels(sums, channels, 1);
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_NEAR(fits[c].gain, own.intensity[c].gain, 1e-9);
      EXPECT_NEAR(fits[c].offset, own.intensity[c].offset, 1e-7);
    }
  }
}

TEST(ViewSynthesizer, TakesAGivenFit) {
  expect_given_fits_to_act<std::uint8_t>(1);
  expect_given_fits_to_act<std::uint8_t>(4);
  expect_given_fits_to_act<std::uint16_t>(3);
  expect_given_fits_to_act<float>(3);
}

/// Intensities are regressed on every third of 200 rows, from the second on: the others, here with
/// another brightness, do not count.
TEST(ViewSynthesizer, RegressesOnRowsAtEqualDistances) {
  std::mt19937 random(29);
  constexpr int kHeight = 200;
  Pair pair = random_pair<std::uint8_t>(random, 50, kHeight, 3);
  const ViewSynthesizer synthesizer({}, execution());
  const auto fit = [&] {
    SynthesizedView view;
    synthesizer.synthesize(
        {pair.left, pair.right, pair.left_disparity.view(), pair.right_disparity.view()}, 0.4,
        view);
    return view.intensity;
  };
  const auto brighten = [&](int first_row, int step) {
    auto& right = std::get<Image<std::uint8_t>>(pair.right.pixels);
    for (int y = first_row; y < kHeight; y += step) {
      for (int i = 0; i < right.width() * 3; ++i) {
        right.row(y)[i] = static_cast<std::uint8_t>(right.row(y)[i] / 2 + 100);
      }
    }
  };
  const std::array<IntensityFit, 4> before = fit();
  brighten(0, 3);
  brighten(2, 3);
  EXPECT_EQ(fit(), before);
  brighten(1, 3);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(fit()[c].gain, before[c].gain / 2, 0.01);
    EXPECT_GT(fit()[c].offset, before[c].offset / 2 + 90);
  }
}

}  // namespace vantage::view_synthesizer_test
