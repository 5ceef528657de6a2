#include "engine/matching/stereo_matcher.h"

#include "tests/engine/engine_test.h"
#include "tests/engine/plain_matching.h"
#include "tests/engine/random_grey.h"
#include "tests/test_sample.h"

namespace vantage::stereo_matcher_test {

MatchOptions raw_options(DisparityRange range, int window, Border border, Subpixel subpixel) {
  MatchOptions options;
  options.method = MatchMethod::kSsd;
  options.disparities = range;
  options.parameters.window_px = window;
  options.parameters.border = border;
  options.parameters.subpixel = subpixel;
  options.raw = true;
  return options;
}

bool has_candidate(const PlainMap& map) {
  return std::any_of(map.choices.begin(), map.choices.end(),
                     [](const PlainChoice& choice) { return !std::isnan(choice.disparity); });
}

PlainMap plain_map(const Photograph& left, const Photograph& right, Side reference,
                   const MatchOptions& options) {
  return plain_match(left, right, reference, options.disparities, options.resolved());
}

/// Exact equality, cell for cell; disparities from sub-pixel fits may differ in the last bit of a
/// float because means are formed in another order.
void expect_equals_plain_match(const Photograph& left, const Photograph& right,
                               const MatchOptions& options, Execution& execution) {
  const StereoMatcher matcher(options, execution);
  DisparityMaps maps;
  matcher.match(left, right, {}, maps);
  for (const Side reference : {Side::kLeft, Side::kRight}) {
    const PlainMap plain = plain_map(left, right, reference, options);
    const DisparityMap& map =
        reference == Side::kLeft ? maps.left.disparity_px : maps.right.disparity_px;
    ASSERT_EQ(map.width(), left.width());
    ASSERT_EQ(map.height(), left.height());
    for (const auto [x, y] : positions_of(map)) {
      const double expected = plain.at(x, y).disparity;
      const double actual = map.at(x, y);
      if (std::isnan(expected)) {
        ASSERT_TRUE(std::isnan(actual)) << "at " << x << ", " << y;
      } else {
        ASSERT_NEAR(actual, expected, options.resolved().subpixel == Subpixel::kNone ? 0 : 1e-4)
            << "at " << x << ", " << y;
      }
    }
  }
}

struct Shape {
  int width;
  int height;
  DisparityRange range;
  int window;
};

constexpr Shape kShapes[] = {
    {1, 1, {0, 0}, 1},      {1, 1, {-3, 3}, 9},    {1, 7, {0, 3}, 3},      {7, 1, {0, 3}, 3},
    {3, 3, {-2, 2}, 5},     {15, 9, {0, 15}, 3},   {16, 9, {-16, 16}, 3},  {17, 11, {-8, 7}, 5},
    {31, 13, {3, 40}, 7},   {33, 8, {-40, 33}, 9}, {47, 6, {-30, -2}, 3},  {61, 19, {0, 63}, 9},
    {64, 12, {0, 64}, 21},  {65, 10, {5, 100}, 1}, {37, 23, {0, 12}, 101}, {101, 17, {-5, 70}, 11},
    {131, 15, {0, 15}, 13}, {61, 9, {0, 15}, 31},  {20, 5, {40, 60}, 3}};
constexpr int kShapeCount = static_cast<int>(std::size(kShapes));

class SsdShapes : public ::testing::TestWithParam<int> {};

TEST_P(SsdShapes, EqualPlainMatch) {
  const Shape& shape = kShapes[GetParam()];
  static const auto rows = sampled_rows({kShapeCount, 2, 2, 2});
  for (const SampleRow& row : rows_of(rows, GetParam())) {
    SCOPED_TRACE(::testing::Message() << "shape, border, subpixel, levels: "
                                      << ::testing::PrintToString(row) << ", " << sample_name());
    const MatchOptions options =
        raw_options(shape.range, shape.window, row[1] == 0 ? Border::kClip : Border::kValid,
                    row[2] == 0 ? Subpixel::kNone : Subpixel::kParabola);
    // With two levels most energies tie: sub-pixel positions then hang on exact zeros.
    const int levels = row[3] == 0 ? 2 : 256;
    const Photograph left = random_grey(shape.width, shape.height, levels, 1);
    const Photograph right = random_grey(shape.width, shape.height, levels, 2);
    if (possible_range(options.disparities, shape.width).count() < 1 ||
        !has_candidate(plain_map(left, right, Side::kLeft, options))) {
      DisparityMaps maps;
      EXPECT_THROW(StereoMatcher(options, execution()).match(left, right, {}, maps), Error);
      continue;
    }
    expect_equals_plain_match(left, right, options, execution());
  }
}

INSTANTIATE_TEST_SUITE_P(AwkwardSizes, SsdShapes, ::testing::Range(0, kShapeCount),
                         [](const auto& instance) {
                           const Shape& s = kShapes[instance.param];
                           return std::to_string(s.width) + "x" + std::to_string(s.height) +
                                  "_window_" + std::to_string(s.window);
                         });

/// Colour, 16-bit and float photographs: costs are rounded to fixed point, so winners may differ
/// from double arithmetic where energies are as good as equal. That must be rare.
template <typename T>
Photograph random_photograph(int width, int height, int channels, double top, std::uint32_t seed) {
  std::mt19937 random(seed);
  Image<T> image(width, height, channels);
  for (const auto [x, y] : positions_of(width * channels, height)) {
    image.row(y)[x] = static_cast<T>(top * (static_cast<double>(random()) / 4294967295.0));
  }
  return {std::move(image)};
}

class SsdDepths : public ::testing::TestWithParam<int> {
 protected:
  static Photograph photograph(int kind, std::uint32_t seed) {
    switch (kind) {
      case 0:
        return random_photograph<std::uint8_t>(83, 29, 3, 255.99, seed);
      case 1:
        return random_photograph<std::uint16_t>(83, 29, 1, 65535.99, seed);
      case 2:
        return random_photograph<std::uint16_t>(83, 29, 3, 600.99, seed);  // dark 10-bit camera
      case 3:
        return random_photograph<float>(83, 29, 1, 1.0, seed);
      default:
        return random_photograph<std::uint16_t>(83, 29, 4, 65535.99, seed);
    }
  }
};

TEST_P(SsdDepths, AgreeWithDoubleArithmetic) {
  const Photograph left = photograph(GetParam(), 5);
  const Photograph right = photograph(GetParam(), 6);
  for (const int window : {1, 5, 25}) {
    const MatchOptions options = raw_options({-4, 30}, window, Border::kClip, Subpixel::kNone);
    DisparityMaps maps;
    StereoMatcher(options, execution()).match(left, right, {}, maps);
    const Volume energies =
        plain_aggregate(left, right, Side::kLeft, options.disparities, options.resolved());
    const PlainMap plain = plain_select(energies, options.resolved());
    int different = 0;
    for (int y = 0; y < maps.left.disparity_px.height(); ++y) {
      for (int x = 0; x < maps.left.disparity_px.width(); ++x) {
        const double expected = plain.at(x, y).disparity;
        const double actual = maps.left.disparity_px.at(x, y);
        if (actual != expected) {
          ++different;
          const auto energy = [&](double d) {
            return energies.at(x, y, static_cast<int>(d) - energies.range.min);
          };
          // Means of costs that are rounded to at most 1/64 of a squared grey level.
          EXPECT_NEAR(energy(actual), energy(expected), 1.0 / 64) << x << ", " << y;
        }
      }
    }
    // Of 2407 pixels. Single samples of noise come within the rounding of each other more often.
    EXPECT_LE(different, window == 1 ? 7 : 2) << "window " << window;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SsdDepths, ::testing::Range(0, 5));

TEST(StereoMatcher, RefinedMapsAreDense) {
  MatchOptions options;
  options.disparities = {4, 20};  // the left columns have no candidate at all
  DisparityMaps maps;
  StereoMatcher(options, execution())
      .match(random_grey(50, 20, 256, 12), random_grey(50, 20, 256, 13), {}, maps);
  for (const auto [x, y] : positions_of(50, 20)) {
    ASSERT_TRUE(std::isfinite(maps.left.disparity_px.at(x, y)));
    ASSERT_TRUE(std::isfinite(maps.right.disparity_px.at(x, y)));
  }
}

TEST(StereoMatcher, RefusesWhatItCannotDo) {
  DisparityMaps maps;
  const Photograph image = random_grey(20, 10, 256, 14);
  EXPECT_THROW(StereoMatcher({}, execution()).match(image, random_grey(21, 10, 256, 1), {}, maps),
               Error);
  MatchOptions options;
  options.disparities = {20, 30};
  EXPECT_THROW(StereoMatcher(options, execution()).match(image, image, {}, maps), Error);
  options = {};
  options.method = MatchMethod::kSsd;
  options.parameters.window_px = 8;
  EXPECT_THROW(StereoMatcher(options, execution()), UsageError);
  options = {};
  options.disparities = {5, 4};
  EXPECT_THROW(StereoMatcher(options, execution()), UsageError);
  options = {};
  options.refinement.cross_check_px = std::nan("");
  EXPECT_THROW(StereoMatcher(options, execution()), UsageError);
}

}  // namespace vantage::stereo_matcher_test
