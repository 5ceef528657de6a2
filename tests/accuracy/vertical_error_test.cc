#include "engine/rectification/vertical_error.h"

#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/rectification/rectifier.h"
#include "engine/rectification/rows/row_check.h"
#include "engine/rectification/uncalibrated_rig.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/unrectified_pair.h"
#include "tests/test_paths.h"

namespace vantage::vertical_error_test {

struct SceneImages {
  Photograph left;
  Photograph right;
};

const SceneImages& scene_images() {
  static const SceneImages images = [] {
    const LayeredScene scene({.width_px = 320, .height_px = 240, .samples_per_side = 2},
                             execution());
    return SceneImages{scene.render({0, 0}, 0).image, scene.render({1, 0}, 0).image};
  }();
  return images;
}

/// Matches whose vertical error is `error` of x, y and disparity.
template <typename Error>
std::vector<PointMatch> matches_with(int count, const Error& error, std::mt19937& random) {
  std::vector<PointMatch> matches;
  for (int i = 0; i < count; ++i) {
    const double x = uniform(random, 0, 639);
    const double y = uniform(random, 0, 479);
    const double d = uniform(random, -5, 60);
    matches.push_back({.left = {x, y}, .right = {x - d, y - error(x, y, d)}});
  }
  return matches;
}

TEST(VerticalError, OfExactMatchesIsThatOfTheirRows) {
  std::mt19937 random(1);
  const auto none = vertical_error(matches_with(
      200, [](double, double, double) { return 0.0; }, random));
  ASSERT_TRUE(none);
  EXPECT_EQ(none->inliers, 200);
  EXPECT_EQ(none->rms_px, 0);
  EXPECT_EQ(none->max_px, 0);
  EXPECT_NEAR(none->min_disparity_px, -5, 2);
  EXPECT_NEAR(none->max_disparity_px, 60, 2);

  const auto matches = matches_with(
      500, [](double x, double y, double) { return -2 + x / 200 + y * y / 1e5; }, random);
  double sum = 0;
  double sum_of_squares = 0;
  double sum_absolute = 0;
  double largest = 0;
  std::vector<double> absolute;
  for (const PointMatch& match : matches) {
    const double error = match.left.y() - match.right.y();
    sum += error / 500;
    sum_of_squares += error * error / 500;
    sum_absolute += std::abs(error) / 500;
    largest = std::max(largest, std::abs(error));
    absolute.push_back(std::abs(error));
  }
  std::sort(absolute.begin(), absolute.end());
  const auto found = vertical_error(matches);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->inliers, 500);
  EXPECT_NEAR(found->mean_px, sum, 1e-9);
  EXPECT_NEAR(found->rms_px, std::sqrt(sum_of_squares), 1e-9);
  EXPECT_NEAR(found->systematic_px, std::sqrt(sum_of_squares), 1e-5);
  EXPECT_NEAR(found->mean_absolute_px, sum_absolute, 1e-9);
  EXPECT_EQ(found->max_px, largest);
  EXPECT_EQ(found->percentile_95_px, absolute[474]);
}

TEST(VerticalError, LeavesWrongMatchesOutAndTellsNoiseFromError) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.2);
  auto matches = matches_with(
      600, [&](double x, double, double d) { return 0.4 + x / 3000 + d / 500 + noise(random); },
      random);
  double clean = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double x = matches[i].left.x();
    const double d = x - matches[i].right.x();
    clean += std::pow(0.4 + x / 3000 + d / 500, 2) / 600;
    if (i % 10 < 4) {
      matches[i].right.y() = uniform(random, 0, 479);
    }
  }
  const auto found = vertical_error(matches);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->matches, 600);
  EXPECT_NEAR(found->inliers, 360, 6);
  EXPECT_NEAR(found->systematic_px, std::sqrt(clean), 0.04);
  EXPECT_NEAR(found->rms_px, std::hypot(std::sqrt(clean), 0.2), 0.05);
  EXPECT_LT(found->max_px, 2);
}

// Even where the error is 0 on average, as of a camera that is turned about its axis.
TEST(VerticalError, IsFoundWhereItChangesOverTheImage) {
  const auto& [left, right] = scene_images();
  constexpr double kTurn = 0.006;
  const Eigen::Matrix3d turn = turned_by(0, 0, kTurn);
  const Eigen::Matrix3d to_middle{{1, 0, -159.5}, {0, 1, -119.5}, {0, 0, 1}};
  const auto found =
      check_rectification(left, warped(right, to_middle.inverse() * turn * to_middle));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->mean_px, 0, 0.1);
  // Of points that are evenly spread over the width.
  EXPECT_NEAR(found->systematic_px, kTurn * 320 / std::sqrt(12), 0.1);
}

TEST(VerticalError, TellsExchangedImages) {
  const auto& [left, right] = scene_images();
  const auto in_order = check_rectification(left, right);
  const auto exchanged = check_rectification(right, left);
  ASSERT_TRUE(in_order && exchanged);
  EXPECT_LT(in_order->negative_share, 0.02);
  EXPECT_FALSE(in_order->looks_exchanged());
  EXPECT_GT(exchanged->negative_share, 0.98);
  EXPECT_TRUE(exchanged->looks_exchanged());

  // Disparities around 0 say nothing.
  std::mt19937 random(4);
  auto matches = matches_with(
      200, [](double, double, double) { return 0.0; }, random);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    matches[i].right.x() = matches[i].left.x() + (i % 10 == 0 ? 3 : 0.4);
  }
  EXPECT_DOUBLE_EQ(vertical_error(matches).value().negative_share, 0.1);
}

TEST(VerticalError, SaysNothingOfTooFewMatches) {
  std::mt19937 random(3);
  const auto zero = [](double, double, double) { return 0.0; };
  EXPECT_FALSE(vertical_error({}));
  EXPECT_FALSE(vertical_error(matches_with(kMinMatches - 1, zero, random)));
  EXPECT_TRUE(vertical_error(matches_with(kMinMatches, zero, random)));
  // All in one place.
  EXPECT_TRUE(vertical_error(std::vector<PointMatch>(40, {{3, 4}, {1, 4}})));

  const Photograph flat = {[] {
    Image<std::uint8_t> image(80, 60);
    image.fill(9);
    return image;
  }()};
  EXPECT_FALSE(check_rectification(flat, flat));
}

TEST(VerticalError, IsFoundInPictures) {
  const auto& [left, right] = scene_images();
  const auto rectified = check_rectification(left, right);
  ASSERT_TRUE(rectified);
  EXPECT_LT(rectified->systematic_px, 0.08);
  for (const double shift : {0.4, -1.3}) {
    Eigen::Matrix3d down = Eigen::Matrix3d::Identity();
    down(1, 2) = shift;
    const Photograph shifted = warped(right, down);
    {
      const std::optional<VerticalError> found =
          shift > 0 ? check_rectification(left, shifted)
                    : vertical_error(match_features(left, shifted));
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->mean_px, -shift, 0.08);
      EXPECT_NEAR(found->systematic_px, std::abs(shift), 0.08);
      EXPECT_NEAR(found->min_disparity_px, 4, 3);
      EXPECT_GT(found->max_disparity_px, 10);
      EXPECT_LT(found->max_disparity_px, 20.5);
    }
  }
}

TEST(VerticalError, IsGoneOnceEstimatedCamerasHaveRectified) {
  const RenderedPair pair = unrectified_pair(execution());
  const auto before = check_rectification(pair.left, pair.right);
  ASSERT_TRUE(before);
  EXPECT_GT(before->systematic_px, 5);
  const UncalibratedRig rig = estimate_rig(match_features(pair.left, pair.right), 320, 240);
  const Rectifier rectifier(rig.calibration, 320, 240);
  Photograph left;
  Photograph right;
  rectifier.apply(pair.left, Side::kLeft, left, execution());
  rectifier.apply(pair.right, Side::kRight, right, execution());
  const auto after = vertical_error(match_features(left, right));
  ASSERT_TRUE(after);
  EXPECT_LT(after->systematic_px, 0.15);
  EXPECT_LT(after->rms_px, 0.3);
}

TEST(VerticalError, OfTheMotorcycleIsThatOfItsTruth) {
  const std::filesystem::path folder = test_paths::shared_data() / "motorcycle";
  if (!std::filesystem::exists(folder / "disp0y.pfm")) {
    GTEST_SKIP() << "no imperfectly rectified pair at " << folder;
  }
  const Photograph left = read_photograph(folder / "im0.png");
  const Photograph right = read_photograph(folder / "im1.png");
  const DisparityMap truth = read_disparity(folder / "disp0y.pfm");
  double sum = 0;
  int points = 0;
  for (const PointMatch& match : match_features(left, right)) {
    const double error = match.left.y() - match.right.y();
    // The file holds y_right − y_left.
    const double expected = -truth.at(static_cast<int>(std::lround(match.left.x())),
                                      static_cast<int>(std::lround(match.left.y())));
    if (std::isfinite(expected) && std::abs(error - expected) < 1) {
      sum += error - expected;
      ++points;
    }
  }
  EXPECT_GT(points, 800);
  EXPECT_NEAR(sum / points, 0, 0.12);
  const auto found = check_rectification(left, right);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->mean_px, 0.23, 0.12);
  EXPECT_NEAR(found->systematic_px, 0.235, 0.03);  // RMS of the truth, disp0y.pfm
  const auto perfect = test_paths::shared_data() / "motorcycle_perfect";
  const auto other = check_rectification(read_photograph(perfect / "im0.png"),
                                         read_photograph(perfect / "im1.png"));
  ASSERT_TRUE(other);
  EXPECT_LT(other->systematic_px, 0.15);
}

}  // namespace vantage::vertical_error_test
