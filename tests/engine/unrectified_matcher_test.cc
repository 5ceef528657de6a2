// Matching photographs that are not rectified, against a generated scene and against rectified
// pairs.
#include "engine/matching/unrectified_matcher.h"

#include <Eigen/Geometry>

#include "engine/generation/layered_scene.h"
#include "engine/matching/options/method_names.h"
#include "engine/matching/search/epipolar/rectified_map.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/rectification/epipolar_grid.h"
#include "tests/engine/engine_test.h"

namespace vantage::unrectified_matcher_test {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

PosedCamera turned(const LayeredScene& scene, SceneView view, const Eigen::Vector3d& degrees) {
  PosedCamera camera = scene.camera(view);
  const Eigen::Vector3d angles = degrees * (M_PI / 180);
  camera.rotation = (Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
  camera.translation = -camera.rotation * Eigen::Vector3d(view.x, view.y, 0);
  return camera;
}

/// Two turned cameras of a generated scene.
class UnrectifiedMatching : public testing::Test {
 protected:
  UnrectifiedMatching() {
    calibration_.left.matrix = left_camera_.matrix;
    calibration_.right.matrix = right_camera_.matrix;
    calibration_.rotation = right_camera_.rotation * left_camera_.rotation.transpose();
    calibration_.translation =
        right_camera_.translation - calibration_.rotation * left_camera_.translation;
  }

  /// The point seen at a pixel of the left photograph, in the left camera's frame.
  [[nodiscard]] Eigen::Vector3d point_at(int x, int y) const {
    const Eigen::Vector3d ray = left_camera_.matrix.inverse() * Eigen::Vector3d(x, y, 1);
    return ray * (scene_.focal_length_px() / left_.disparity.at(x, y));
  }
  /// Of the rectified pair.
  [[nodiscard]] double true_disparity_px(const Rectifier& rectifier, int x, int y) const {
    const RectifiedCamera& camera = rectifier.pair().left;
    return camera.matrix(0, 0) * rectifier.pair().baseline / (camera.rotation * point_at(x, y)).z();
  }
  /// Share of the pixels that both cameras see whose disparity is wrong by more than 1 px.
  [[nodiscard]] double bad_share(const Rectifier& rectifier, const DisparityMap& map) const {
    const Mask hidden = scene_.occlusion(left_camera_, right_camera_, 0);
    int bad = 0;
    int all = 0;
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      if (hidden.at(x, y) == 0) {
        ++all;
        bad += std::abs(map.at(x, y) - true_disparity_px(rectifier, x, y)) <= 1 ? 0 : 1;
      }
    }
    return static_cast<double>(bad) / all;
  }

  /// Rendered once.
  struct Pair {
    Execution execution{{.threads = 2}};
    LayeredScene scene{{.width_px = kWidth, .height_px = kHeight}, execution};
    PosedCamera left_camera = turned(scene, {0, 0}, {1, 1.5, 2});
    PosedCamera right_camera = turned(scene, {1, 0}, {-0.5, -1, -1.5});
    SceneRendering left = scene.render(left_camera, 0);
    SceneRendering right = scene.render(right_camera, 0);
  };
  static const Pair& pair() {
    static const Pair made;
    return made;
  }

  Execution execution_{{.threads = 2}};
  const LayeredScene& scene_ = pair().scene;
  const PosedCamera& left_camera_ = pair().left_camera;
  const PosedCamera& right_camera_ = pair().right_camera;
  const SceneRendering& left_ = pair().left;
  const SceneRendering& right_ = pair().right;
  StereoCalibration calibration_;
};

TEST_F(UnrectifiedMatching, LinesPassThroughWhatBothCamerasSee) {
  const Rectifier rectifier(calibration_, kWidth, kHeight);
  const EpipolarGrid grid(rectifier, Side::kLeft, execution_);
  int compared = 0;
  for (int y = 0; y < kHeight; y += 7) {
    for (int x = 0; x < kWidth; x += 5) {
      const EpipolarGrid::Place& place = grid.place(x, y);
      if (!place.has_line) {
        continue;
      }
      const Eigen::Vector3d seen =
          calibration_.right.matrix *
          (calibration_.rotation * point_at(x, y) + calibration_.translation);
      const double steps = true_disparity_px(rectifier, x, y);
      const Eigen::Vector2d at =
          grid.position_of(place.line, place.sample - steps * EpipolarGrid::kPhases);
      if (!at.hasNaN()) {
        // Lines are a quarter of a rectified pixel apart.
        EXPECT_LT((at - seen.hnormalized()).norm(), 0.25) << x << ", " << y;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 300);
}

TEST_F(UnrectifiedMatching, FindsTheSceneAsWellAsInRectifiedImages) {
  const Rectifier rectifier(calibration_, kWidth, kHeight);
  for (const MatchPreset preset : {MatchPreset::kRealtime, MatchPreset::kBalanced}) {
    MatchOptions options;
    options.disparities = {0, 16};
    options.preset = preset;
    DisparityMaps maps;
    UnrectifiedMatcher(options, rectifier, execution_).match(left_.image, right_.image, {}, maps);
    EXPECT_LT(bad_share(rectifier, maps.left.disparity_px), 0.08);
    EXPECT_EQ(maps.right.disparity_px.width(), kWidth);
  }
}

TEST_F(UnrectifiedMatching, DoesNotDependOnThreadsOrStrips) {
  const Rectifier rectifier(calibration_, kWidth, kHeight);
  MatchOptions options;
  options.disparities = {0, 16};
  DisparityMaps maps;
  UnrectifiedMatcher(options, rectifier, execution_).match(left_.image, right_.image, {}, maps);
  Execution alone({.threads = 1, .strip_width_px = 23});
  DisparityMaps same;
  UnrectifiedMatcher(options, rectifier, alone).match(left_.image, right_.image, {}, same);
  EXPECT_TRUE(identical(maps.left.disparity_px, same.left.disparity_px));
  EXPECT_TRUE(identical(maps.right.disparity_px, same.right.disparity_px));
}

// Of a rectified pair, lines are rows and samples pixels.
TEST_F(UnrectifiedMatching, OfARectifiedPairIsItsMap) {
  StereoCalibration straight;
  straight.left.matrix = straight.right.matrix = scene_.camera({0, 0}).matrix;
  straight.is_rectified = true;
  const Rectifier rectifier(straight, kWidth, kHeight);
  const Photograph left = scene_.render(SceneView{0, 0}, 0).image;
  const Photograph right = scene_.render(SceneView{1, 0}, 0).image;
  MatchOptions options;
  options.disparities = {0, 16};
  options.raw = true;
  for (const MatchMethod method :
       {MatchMethod::kSsd, MatchMethod::kDiffusion, MatchMethod::kGradient}) {
    options.method = method;
    DisparityMaps expected;
    StereoMatcher(options, execution_).match(left, right, {}, expected);
    DisparityMaps maps;
    UnrectifiedMatcher(options, rectifier, execution_).match(left, right, {}, maps);
    int different = 0;
    constexpr int kBorder = 16 + 30;  // what lies outside differs, and spreads
    for (const auto [x, y] : positions_of({kBorder, kWidth - kBorder}, {0, kHeight})) {
      different +=
          std::abs(maps.left.disparity_px.at(x, y) - expected.left.disparity_px.at(x, y)) < 1e-4F
              ? 0
              : 1;
    }
    EXPECT_EQ(different, 0) << name_of(method);
  }
}

TEST_F(UnrectifiedMatching, MapsCanBeBroughtToTheRectifiedImages) {
  const Rectifier rectifier(calibration_, kWidth, kHeight);
  MatchedMap map;
  map.disparity_px.resize(kWidth, kHeight);
  map.unmatched.resize(kWidth, kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    map.disparity_px.at(x, y) = static_cast<float>(1000 * y + x);
    map.unmatched.at(x, y) = 0;
  }
  bring_to_rectified(rectifier, Side::kLeft, execution_, map);
  EXPECT_TRUE(map.confidence.empty());
  for (int y = 0; y < kHeight; y += 9) {
    for (int x = 0; x < kWidth; x += 7) {
      const auto source = rectifier.source_position(Side::kLeft, {x, y});
      ASSERT_TRUE(source);
      const int value = static_cast<int>(map.disparity_px.at(x, y));
      EXPECT_NEAR(value % 1000, source->x(), 0.5);
      EXPECT_NEAR(value / 1000, source->y(), 0.5);
      EXPECT_EQ(map.unmatched.at(x, y), 0);
    }
  }
}

TEST_F(UnrectifiedMatching, RefusesWhatNeedsRows) {
  const Rectifier rectifier(calibration_, kWidth, kHeight);
  MatchOptions options;
  options.disparities = {0, 16};
  options.parameters.selection = Selection::kSymmetric;
  EXPECT_THROW(UnrectifiedMatcher(options, rectifier, execution_), UsageError);
  options.parameters.selection.reset();
  options.disparities_y = DisparityRange{-1, 1};
  EXPECT_THROW(UnrectifiedMatcher(options, rectifier, execution_), UsageError);
}

}  // namespace vantage::unrectified_matcher_test
