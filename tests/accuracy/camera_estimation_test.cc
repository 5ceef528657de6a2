// Cameras of hand-held photographs, against those that made the images.
#include "engine/pose_estimation/camera_estimation.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "engine/generation/layered_scene.h"
#include "tests/engine/engine_test.h"

namespace vantage::camera_estimation_test {

constexpr double kDegree = std::numbers::pi / 180;

Eigen::Matrix3d turn(double x, double y, double z) {
  const Eigen::Vector3d radians = kDegree * Eigen::Vector3d(x, y, z);
  return Eigen::AngleAxisd(radians.norm(), radians.normalized()).toRotationMatrix();
}

/// Six photographs of 320×240 pixels from an arc of 16 degrees, and an unrelated one.
class HandHeld : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    LayeredSceneOptions options;
    options.width_px = 320;
    options.height_px = 240;
    options.samples_per_side = 2;
    const LayeredScene scene(options, execution());
    const std::array<double, 6> shake = {0.6, -0.4, 0.9, -1, 0.3, -0.7};
    for (int i = 0; i < 6; ++i) {
      const double angle = -8 + 3.2 * i;
      const double s = shake.at(static_cast<std::size_t>(i));
      constexpr double kFar = 35;
      PosedCamera camera = scene.camera({});
      const Eigen::Vector3d centre(0.5 + kFar * std::sin(angle * kDegree), s,
                                   kFar - kFar * std::cos(angle * kDegree) - s);
      camera.rotation = turn(s, -0.5 * s, 4 * s) * turn(0, angle, 1e-9);
      camera.translation = -camera.rotation * centre;
      cameras().push_back(camera);
      images().push_back(scene.render(camera, 0).image);
    }
    options.seed = 77;
    options.has_boards = true;
    images().push_back(LayeredScene(options, execution()).render(SceneView{}, 60).image);
  }

  static Execution& execution() {
    static Execution shared({.threads = 2});
    return shared;
  }
  static std::vector<PosedCamera>& cameras() {
    static std::vector<PosedCamera> all;
    return all;
  }
  static std::vector<Photograph>& images() {
    static std::vector<Photograph> all;
    return all;
  }

  static CameraEstimate estimate(std::size_t count, const CameraEstimationOptions& options,
                                 Execution& with = execution()) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < count; ++i) {
      names.push_back(std::to_string(i));
    }
    return estimate_cameras(
        names,
        [](int image) {
          const auto& pixels =
              std::get<Image<std::uint8_t>>(images()[static_cast<std::size_t>(image)].pixels);
          return Photograph{pixels.copy()};
        },
        options, {}, with);
  }
  static Camera true_lens() { return {.matrix = cameras()[0].matrix, .distortion = {}}; }

  /// Turns between cameras within `degrees`; positions, after the best similarity, within `share`
  /// of the length of the arc.
  static void expect_poses(const CameraEstimate& estimate, double degrees, double share) {
    Eigen::Matrix3Xd from(3, 6);
    Eigen::Matrix3Xd to(3, 6);
    for (int i = 0; i < 6; ++i) {
      const auto number = static_cast<std::size_t>(i);
      ASSERT_TRUE(estimate.images[number].pose) << estimate.images[number].problem;
      const Eigen::Matrix3d found = estimate.images[number].pose->rotation;
      const Eigen::Matrix3d truth = cameras()[number].rotation * cameras()[0].rotation.transpose();
      EXPECT_LT(Eigen::AngleAxisd(Eigen::Matrix3d(truth * found.transpose())).angle() / kDegree,
                degrees);
      from.col(i) = estimate.images[number].pose->centre();
      to.col(i) = cameras()[number].centre();
    }
    const Eigen::Matrix4d similarity = Eigen::umeyama(from, to);
    const double worst =
        (similarity.topRows<3>() * from.colwise().homogeneous() - to).colwise().norm().maxCoeff();
    EXPECT_LT(worst, share * (to.col(5) - to.col(0)).norm());
  }
};

TEST_F(HandHeld, CamerasOfAKnownLens) {
  const CameraEstimate found = estimate(6, {.lens = true_lens()});
  expect_poses(found, 0.15, 0.005);
  EXPECT_LT(found.median_px, 0.5);
  EXPECT_LE(found.median_px, found.start_median_px);
  EXPECT_EQ(found.pairs.size(), 15U);
  for (const EstimatedPair& pair : found.pairs) {
    EXPECT_EQ(pair.refusal, "");
  }
}

TEST_F(HandHeld, TheLensIsFoundAndUnrelatedImagesAreLeftOut) {
  const CameraEstimate found = estimate(7, {});
  expect_poses(found, 0.3, 0.01);
  EXPECT_NEAR(found.lens.matrix(0, 0), 320, 10);
  EXPECT_FALSE(found.images[6].pose);
  EXPECT_THAT(found.images[6].problem, testing::HasSubstr("no pair joins it"));
  // The unit: the median distance from the nearest camera.
  std::vector<double> nearest;
  for (std::size_t i = 0; i < 6; ++i) {
    double distance = 1e9;
    for (std::size_t k = 0; k < 6; ++k) {
      if (k != i) {
        distance = std::min(
            distance, (found.images[i].pose->centre() - found.images[k].pose->centre()).norm());
      }
    }
    nearest.push_back(distance);
  }
  std::sort(nearest.begin(), nearest.end());
  EXPECT_NEAR(nearest[3], 1, 1e-9);
}

TEST_F(HandHeld, ResultsDoNotDependOnThreads) {
  Execution one({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  const CameraEstimationOptions options{.lens = true_lens(), .partners = 1};
  const CameraEstimate first = estimate(4, options);
  const CameraEstimate second = estimate(4, options, one);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(first.images[i].pose, second.images[i].pose);
  }
}

TEST_F(HandHeld, ImagesOfNoCommonSceneAreRefused) {
  const auto load = [](int image) {
    return Photograph{std::get<Image<std::uint8_t>>(images()[image == 0 ? 0U : 6U].pixels).copy()};
  };
  EXPECT_THROW((void)estimate_cameras({"a", "b"}, load, {}, {}, execution()), Error);
  EXPECT_THROW((void)estimate_cameras({"a"}, load, {}, {}, execution()), Error);
  EXPECT_THROW((void)estimate_cameras({"a", "b"}, load, {.partners = 0}, {}, execution()),
               UsageError);
}

}  // namespace vantage::camera_estimation_test
