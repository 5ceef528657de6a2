// Rows that do not correspond: what pairs say of them, and their correction.

#include "engine/rectification/rows/row_field.h"

#include "engine/matching/pair_matcher.h"
#include "engine/matching/volume/posterior_moments.h"
#include "engine/rectification/rows/row_check.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/rectification/rows/row_points.h"
#include "engine/rectification/rows/row_track.h"
#include "tests/engine/engine_test.h"

namespace vantage::row_field_test {

constexpr int kWidth = 360;
constexpr int kHeight = 250;

double between(std::mt19937& random, double min, double max) {
  return std::uniform_real_distribution(min, max)(random);
}

/// Points with this offset of rows, but 30 % wrong ones, in part of the width.
template <typename Offset>
std::vector<PointMatch> points_of(const Offset& offset, double part = 1) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<PointMatch> points;
  for (int i = 0; i < 300; ++i) {
    const double x = between(random, 0, part * (kWidth - 1));
    const double y = between(random, 0, kHeight - 1);
    const double v = i % 10 < 3 ? between(random, -4, 4) : offset(x, y) + noise(random);
    points.push_back({.left = {x + between(random, 0, 40), y}, .right = {x, y + v}});
  }
  return points;
}

std::optional<RowEstimate> fit(const std::vector<PointMatch>& points) {
  return fit_rows(points, kWidth, kHeight);
}

TEST(RowField, HasTheTermsThatPointsCarry) {
  const auto offset = fit(points_of([](double, double) { return 1.3; }));
  ASSERT_TRUE(offset);
  EXPECT_EQ(offset->terms, 1);
  EXPECT_NEAR(offset->field.offset_px(), 1.3, 0.03);
  EXPECT_TRUE(offset->pays());

  const auto turned = [](double x, double) { return 3 * (x / (kWidth - 1) - 0.5); };
  const auto turn = fit(points_of(turned));
  ASSERT_TRUE(turn);
  EXPECT_EQ(turn->terms, 3);
  EXPECT_NEAR(turn->field.turn_degrees(), std::atan(3.0 / kWidth) * 180 / std::numbers::pi, 0.02);

  const auto bent = [](double x, double y) {
    const double u = 2 * x / (kWidth - 1) - 1;
    const double w = (2 * y - kHeight + 1) / kWidth;
    return -0.5 + u * w + 1.2 * w * w;
  };
  const auto homography = fit(points_of(bent));
  ASSERT_TRUE(homography);
  EXPECT_EQ(homography->terms, 5);
  for (const auto& [x, y] : {std::pair(0, 0), {kWidth - 1, 0}, {180, 125}, {20, kHeight - 1}}) {
    EXPECT_NEAR(homography->field.at(x, y), bent(x, y), 0.12) << x << ", " << y;
    EXPECT_NEAR(homography->field.row_of_left(x, y + bent(x, y)), y, 0.13) << x << ", " << y;
  }
}

TEST(RowField, IsNotMoreThanPointsSay) {
  const auto small = fit(points_of([](double, double) { return 0.06; }));
  ASSERT_TRUE(small);
  EXPECT_FALSE(small->pays());
  // A slope that a tenth of the width shows is not continued over the rest.
  const auto slope = [](double x, double) { return 0.5 + 0.01 * x; };
  const auto narrow = fit(points_of(slope, 0.1));
  ASSERT_TRUE(narrow);
  EXPECT_EQ(narrow->terms, 1);

  std::mt19937 random(5);
  const auto by_chance = [&](double, double) { return between(random, -4, 4); };
  EXPECT_FALSE(fit(points_of(by_chance)));
  auto few = points_of([](double, double) { return 1.0; });
  few.resize(kMinRowPoints - 1);
  EXPECT_FALSE(fit(few));
  EXPECT_FALSE(fit(points_of([](double, double) { return kMaxCorrection_px + 1; })));
}

/// A texture without repetition, in grey levels: random values on a lattice, smooth between them.
double texture(double x, double y) {
  constexpr double kCell_px = 5;
  const auto value = [](double column, double row) {
    std::uint32_t hash = static_cast<std::uint32_t>(static_cast<int>(column) + 1000) * 73856093U ^
                         static_cast<std::uint32_t>(static_cast<int>(row) + 1000) * 19349663U;
    hash = (hash ^ (hash >> 15)) * 2246822519U;
    return static_cast<double>((hash ^ (hash >> 13)) % 256);
  };
  const double column = std::floor(x / kCell_px);
  const double row = std::floor(y / kCell_px);
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double u = smooth(x / kCell_px - column);
  const double w = smooth(y / kCell_px - row);
  return (1 - w) * std::lerp(value(column, row), value(column + 1, row), u) +
         w * std::lerp(value(column, row + 1), value(column + 1, row + 1), u);
}

/// One image of a plane, `down` rows lower, with noise.
template <typename T>
Photograph picture(double along, double down, double noise_levels, double unit) {
  std::mt19937 random(static_cast<unsigned>(10 * along + 3));
  std::normal_distribution<double> noise(0, noise_levels + 1e-9);
  Image<T> image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double grey = std::clamp(texture(x + along, y - down) + noise(random), 0.0, 255.0);
      image.at(x, y) = static_cast<T>(std::lround(unit * grey));
    }
  }
  return {std::move(image)};
}

TEST(RowPoints, AreThoseOfTheTextureAlsoUnderNoise) {
  Execution one({.threads = 1});
  Execution three({.threads = 3});
  const Photograph left = picture<std::uint8_t>(0, 0, 0, 1);
  for (const double noise : {0.0, 12.0}) {
    const Photograph right = picture<std::uint16_t>(9, 1.4, noise, 200);
    const auto points = find_row_points(left, right, &one);
    const auto rows = fit(points);
    ASSERT_TRUE(rows) << noise << ": " << points.size() << " points";
    EXPECT_EQ(rows->terms, 1);
    EXPECT_NEAR(rows->field.offset_px(), 1.4, noise == 0 ? 0.05 : 0.1);
    EXPECT_GT(rows->inliers, 60);
    for (const PointMatch& point : points) {
      EXPECT_GE(point.right.y(), point.left.y() - kRowReach_px - 1);
    }
    const auto same = find_row_points(left, right, &three);
    ASSERT_EQ(same.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(same[i].right, points[i].right);
    }
  }
  Image<std::uint8_t> flat(kWidth, kHeight);
  flat.fill(70);
  EXPECT_THAT(find_row_points({flat.copy()}, {flat.copy()}), IsEmpty());
  EXPECT_THAT(find_row_points(left, {Image<std::uint8_t>(20, 20)}), IsEmpty());
}

TEST(RowCorrection, ResamplesAlongColumnsAndRepeatsBorders) {
  // Bicubic interpolation reproduces a ramp.
  Image<std::uint16_t> ramp(37, 23, 3);
  for (int y = 0; y < 23; ++y) {
    for (int k = 0; k < 37 * 3; ++k) {
      ramp.row(y)[k] = static_cast<std::uint16_t>(1000 + 100 * y + k);
    }
  }
  const RowField field(37, 23, {1.3, 0.4, 0, 0, 0, 0});
  Photograph corrected;
  Execution execution({.threads = 2});
  correct_rows({std::move(ramp)}, field, corrected, execution);
  const auto& pixels = std::get<Image<std::uint16_t>>(corrected.pixels);
  for (int y = 0; y < 23; ++y) {
    for (int x = 0; x < 37; ++x) {
      const double row = y + field.at(x, y);
      if (row < 21) {
        EXPECT_NEAR(pixels.row(y)[3 * x + 1], 1000 + 100 * row + 3 * x + 1, 1) << x << ", " << y;
      } else if (row > 22) {
        EXPECT_EQ(pixels.row(y)[3 * x + 1], 1000 + 2200 + 3 * x + 1) << x << ", " << y;
      }
    }
  }
}

TEST(RowCorrection, MapsComeBackToTheirPixels) {
  MatchedMap map;
  map.disparity_px.resize(5, 12);
  for (int y = 0; y < 12; ++y) {
    std::fill_n(map.disparity_px.row(y), 5, static_cast<float>(y));
  }
  const RowField field(5, 12, {2.2, 0, 0, 0, 0, 0});
  Execution execution({.threads = 2});
  bring_to_given_rows(field, map, execution);  // row y of the given image is y - 2.2 of the left
  EXPECT_EQ(map.disparity_px.at(3, 7), 5);
  EXPECT_EQ(map.disparity_px.at(3, 0), 0);
  EXPECT_TRUE(map.confidence.empty());
  bring_to_corrected_rows(field, map, execution);
  EXPECT_EQ(map.disparity_px.at(3, 5), 5);
}

/// Largest error of a map of the plane, columns and rows near the border left out.
double worst_error_px(const DisparityMap& map_px, double disparity_px) {
  double worst = 0;
  for (const auto [x, y] : positions_of({20, kWidth - 20}, {8, kHeight - 8})) {
    worst = std::max(worst, std::abs(map_px.at(x, y) - disparity_px));
  }
  return worst;
}

TEST(PairMatcher, CorrectsRowsAndBringsRightMapsBack) {
  const Photograph left = picture<std::uint8_t>(0, 0, 0, 1);
  const Photograph right = picture<std::uint8_t>(9, 2.6, 0, 1);
  MatchOptions options;
  options.disparities = {0, 15};
  options.preset = MatchPreset::kRealtime;
  Execution execution({.threads = 2});
  DisparityMaps corrected;
  MatchReport report;
  PairMatcher(options, execution).match(left, right, {}, corrected, &report);
  EXPECT_LT(worst_error_px(corrected.left.disparity_px, 9), 0.3);
  EXPECT_LT(worst_error_px(corrected.right.disparity_px, 9), 0.3);
  ASSERT_FALSE(report.remarks.empty());
  EXPECT_THAT(report.remarks.back().text, HasSubstr("px lower; corrected"));

  // By hand.
  const RowCheck check = check_rows(left, right, &execution);
  Photograph resampled;
  correct_rows(right, check.rows->field, resampled, execution);
  DisparityMaps expected;
  StereoMatcher(options, execution).match(left, resampled, {}, expected);
  bring_to_given_rows(check.rows->field, expected.right, execution);
  EXPECT_TRUE(identical(corrected.left.disparity_px, expected.left.disparity_px));
  EXPECT_TRUE(identical(corrected.right.disparity_px, expected.right.disparity_px));
  EXPECT_TRUE(identical(corrected.right.unmatched, expected.right.unmatched));

  DisparityMaps as_given;
  MatchReport of_given;
  const PairMatcher as_is(options, execution, RowMode::kAsIs);
  as_is.match(left, right, {}, as_given, &of_given);
  StereoMatcher(options, execution).match(left, right, {}, expected);
  EXPECT_TRUE(identical(as_given.left.disparity_px, expected.left.disparity_px));
  EXPECT_THAT(of_given.remarks, Not(Contains(testing::Field(&Remark::subject, "rows"))));

  // Volumes of the right image are not brought back, so its rows stay.
  PosteriorMoments moments;
  const VolumeRequest volume{.side = Side::kRight, .sink = &moments};
  PairMatcher(options, execution).match(left, right, {.volumes = {&volume, 1}}, corrected);
  EXPECT_TRUE(identical(corrected.right.disparity_px, expected.right.disparity_px));
}

TEST(RowTrack, IsInterpolatedInTime) {
  const auto field = [](double offset_px) { return RowField(50, 40, {offset_px, 0, 0, 0, 0, 0}); };
  const RowTrack track{.keys = {{10, field(1)}, {20, field(2)}}};
  EXPECT_EQ(track.at(0).offset_px(), 1);
  EXPECT_DOUBLE_EQ(track.at(13).offset_px(), 1.3);
  EXPECT_EQ(track.at(99).offset_px(), 2);
}

TEST(RowTrack, FollowsARigThatDrifts) {
  Execution execution({.threads = 2});
  SequenceRowSurvey steady;
  SequenceRowSurvey drifting;
  const Photograph left = picture<std::uint8_t>(0, 0, 0, 1);
  for (int pair = 0; pair < 4; ++pair) {
    Photograph right = picture<std::uint8_t>(9, 0.8, 0, 1);
    steady.add(pair, left, right, execution);
    Photograph lower = picture<std::uint8_t>(9, 0.6 * pair, 0, 1);
    drifting.add(pair, left, lower, execution);
  }
  ASSERT_EQ(steady.result().track.keys.size(), 1);
  EXPECT_NEAR(steady.result().track.at(2).offset_px(), 0.8, 0.05);
  ASSERT_EQ(drifting.result().track.keys.size(), 4);
  EXPECT_NEAR(drifting.result().track.at(3).offset_px(), 1.8, 0.05);
}

}  // namespace vantage::row_field_test
