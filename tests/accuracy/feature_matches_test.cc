#include "engine/rectification/feature_matches.h"

#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"
#include "tests/engine/unrectified_pair.h"

namespace vantage::feature_matches_test {

struct ScenePair {
  SceneRendering left;
  SceneRendering right;
};

const ScenePair& scene_pair() {
  static const ScenePair pair = [] {
    const LayeredScene scene({.width_px = 320, .height_px = 240, .samples_per_side = 2},
                             execution());
    return ScenePair{scene.render({0, 0}, 0), scene.render({1, 0}, 0)};
  }();
  return pair;
}

constexpr FeatureKind kKinds[] = {FeatureKind::kSift, FeatureKind::kOrb};

TEST(FeatureMatches, AreWhereTheSceneIs) {
  for (const FeatureKind kind : kKinds) {
    const auto matches =
        match_features(scene_pair().left.image, scene_pair().right.image, {.kind = kind});
    ASSERT_GT(matches.size(), 60U);
    int right = 0;
    double sum_of_squares = 0;
    int quadrants[2][2] = {};
    for (const PointMatch& match : matches) {
      const auto x = static_cast<int>(std::lround(match.left.x()));
      const auto y = static_cast<int>(std::lround(match.left.y()));
      const double truth = scene_pair().left.disparity.at(x, y);
      const double error_y = match.left.y() - match.right.y();
      if (std::abs(match.left.x() - match.right.x() - truth) < 1 && std::abs(error_y) < 1) {
        ++right;
        sum_of_squares += error_y * error_y;
        ++quadrants[y / 120][x / 160];
      }
    }
    EXPECT_GT(right, 0.85 * static_cast<double>(matches.size()));
    EXPECT_LT(std::sqrt(sum_of_squares / right), 0.25);
    for (const auto& row : quadrants) {
      EXPECT_GE(std::min(row[0], row[1]), 5) << "spread over the image";
    }
  }
}

TEST(FeatureMatches, FindPartnersDespiteTurnedCamerasAndExposure) {
  const RenderedPair pair = unrectified_pair(execution());
  Photograph dark;
  const auto& bright = std::get<Image<std::uint8_t>>(pair.right.pixels);
  Image<std::uint16_t> sixteen(bright.width(), bright.height(), bright.channels());
  for (const auto [i, y] : positions_of(bright.width() * bright.channels(), bright.height())) {
    sixteen.row(y)[i] = static_cast<std::uint16_t>(40 * bright.row(y)[i] + 500);
  }
  dark.pixels = std::move(sixteen);
  const Eigen::Vector3d t = pair.calibration.translation;
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  const Eigen::Matrix3d inverse = pair.calibration.left.matrix.inverse();
  const Eigen::Matrix3d fundamental =
      inverse.transpose() * cross * pair.calibration.rotation * inverse;
  for (const Photograph* right : {&pair.right, static_cast<const Photograph*>(&dark)}) {
    const auto matches = match_features(pair.left, *right);
    ASSERT_GT(matches.size(), 60U);
    const auto near_lines = std::count_if(matches.begin(), matches.end(), [&](const auto& match) {
      const Eigen::Vector3d line = fundamental * match.left.homogeneous();
      return std::abs(match.right.homogeneous().dot(line)) / line.head<2>().norm() < 1;
    });
    EXPECT_GT(near_lines, 0.85 * static_cast<double>(matches.size()));
  }
}

TEST(FeatureMatches, OfReducedImagesAreInPixelsOfTheFullOnes) {
  const auto matches = match_features(scene_pair().left.image, scene_pair().right.image,
                                      {.kind = FeatureKind::kOrb, .largest_side_px = 200});
  ASSERT_GT(matches.size(), 20U);
  double largest_x = 0;
  double sum_y = 0;
  for (const PointMatch& match : matches) {
    largest_x = std::max(largest_x, match.left.x());
    sum_y += match.left.y() - match.right.y();
  }
  EXPECT_GT(largest_x, 220);
  EXPECT_NEAR(sum_y / static_cast<double>(matches.size()), 0, 0.5);
}

TEST(FeatureMatches, NoneWhereThereIsNothing) {
  const Photograph textured = crop(scene_pair().left.image, 100, 80, 96, 72);
  for (const FeatureKind kind : kKinds) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {37, 1}, {64, 48}}) {
      Image<std::uint8_t> flat(width, height);
      flat.fill(100);
      const Photograph photograph{std::move(flat)};
      EXPECT_TRUE(match_features(photograph, photograph, {.kind = kind}).empty());
      EXPECT_TRUE(match_features(photograph, textured, {.kind = kind}).empty());
      EXPECT_TRUE(match_features(textured, photograph, {.kind = kind}).empty());
    }
  }
}

TEST(FeatureMatches, AreTheSameFromAnyThread) {
  for (const FeatureKind kind : kKinds) {
    const Photograph left = crop(scene_pair().left.image, 80, 60, 160, 120);
    const Photograph right = crop(scene_pair().right.image, 70, 60, 160, 120);
    const auto find = [&] { return match_features(left, right, {.kind = kind}); };
    const auto expected = find();
    ASSERT_GT(expected.size(), 15U);
    std::vector<PointMatch> others[2];
    std::vector<std::thread> threads;
    for (auto& other : others) {
      threads.emplace_back([&] { other = find(); });
    }
    for (std::thread& thread : threads) {
      thread.join();
    }
    for (const auto& other : others) {
      ASSERT_EQ(other.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_EQ(other[i].left, expected[i].left);
        ASSERT_EQ(other[i].right, expected[i].right);
      }
    }
  }
}

TEST(FeatureMatches, OptionsHaveLimits) {
  EXPECT_EQ(error_of([] { FeatureMatchOptions{.max_features = 99}.validate(); }),
            "most-features is 99, expected a number from 100 to 20000");
  EXPECT_EQ(error_of([] { FeatureMatchOptions{.largest_side_px = 63}.validate(); }),
            "largest-side is 63, expected at least 64");
}

}  // namespace vantage::feature_matches_test
