
#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "engine/generation/layered_scene.h"
#include "engine/rectification/relative_pose.h"
#include "engine/scene_graph/posed_edges.h"
#include "engine/scene_graph/posed_pair.h"
#include "engine/synthesis/blended_warper.h"
#include "tests/engine/engine_test.h"

namespace vantage::posed_cameras_test {

constexpr int kWidth = 120;
constexpr int kHeight = 80;

Camera pinhole() {
  Camera camera;
  camera.matrix << 100, 0, 59.5, 0, 100, 39.5, 0, 0, 1;
  return camera;
}

Eigen::Matrix3d turn(const Eigen::Vector3d& degrees) {
  const Eigen::Vector3d radians = degrees * std::numbers::pi / 180;
  const double angle = radians.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, radians / angle).toRotationMatrix()
                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

SceneCamera camera_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& degrees = {0, 0, 0}) {
  const Eigen::Matrix3d rotation = turn(degrees);
  return {.lens = pinhole(), .pose = {.rotation = rotation, .translation = -rotation * centre}};
}

TEST(PosedPair, RowsCorrespondInEveryDirectionAndNearIsLarge) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> within(-1, 1);
  for (int trial = 0; trial < 24; ++trial) {
    const double direction = trial * std::numbers::pi / 12;
    const Eigen::Vector3d centre(std::cos(direction), std::sin(direction), 0.2 * within(random));
    const auto turned = [&] {
      return Eigen::Vector3d(4 * within(random), 4 * within(random), 10 * within(random));
    };
    const SceneCamera first = camera_at({0, 0, 0}, turned());
    const SceneCamera second = camera_at(centre, turned());
    const RectifiedPair pair =
        rectified_pair(calibration_of(first, second, kWidth, kHeight), kWidth, kHeight,
                       {.kept_outline = 0, .any_direction = true});
    const bool is_upright = pair.width_px == kHeight;
    EXPECT_EQ(pair.width_px + pair.height_px, kWidth + kHeight);
    if (std::abs(std::cos(direction)) > 0.9 || std::abs(std::sin(direction)) > 0.9) {
      EXPECT_EQ(is_upright, std::abs(std::sin(direction)) > 0.5) << direction;
    }
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d point(2 * within(random), 2 * within(random), 12 + 4 * within(random));
      const auto place = [&](const SceneCamera& camera, const RectifiedCamera& rectified) {
        const Eigen::Vector3d seen = camera.pose.rotation * point + camera.pose.translation;
        return Eigen::Vector2d((rectified.matrix * rectified.rotation * seen).hnormalized());
      };
      const Eigen::Vector2d left = place(first, pair.left);
      const Eigen::Vector2d right = place(second, pair.right);
      EXPECT_NEAR(left.y(), right.y(), 1e-9);
      const Eigen::Vector3d seen = first.pose.rotation * point + first.pose.translation;
      const double depth = (pair.left.rotation * seen).z();
      EXPECT_NEAR(left.x() - right.x(), pair.left.matrix(0, 0) * pair.baseline / depth, 1e-9);
    }
  }
}

TEST(PosedPair, MapsComeBackAsNearnessInTheOwnCamera) {
  const SceneCamera first = camera_at({0, 0, 0}, {1, -2, 4});
  const SceneCamera second = camera_at({0.2, 0.9, 0.1}, {-1, 1, -3});
  const StereoCalibration calibration = calibration_of(first, second, kWidth, kHeight);
  const PosedPair pair(calibration, kWidth, kHeight, execution());
  const RectifiedPair geometry =
      rectified_pair(calibration, kWidth, kHeight, {.kept_outline = 0.5, .any_direction = true});
  // The plane Z = 10 of each camera's own frame.
  constexpr double kDepth = 10;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const RectifiedCamera& camera = geometry.camera(side);
    const Eigen::Vector3d normal = camera.rotation.col(2) / kDepth;  // normal · point = 1
    MatchedMap map;
    map.disparity_px.resize(geometry.width_px, geometry.height_px);
    map.unmatched.resize(geometry.width_px, geometry.height_px);
    for (const auto [x, y] : positions_of(geometry.width_px, geometry.height_px)) {
      const Eigen::Vector3d ray = camera.matrix.inverse() * Eigen::Vector3d(x, y, 1);
      const double nearness = normal.dot(ray);  // 1 / depth in the rectified frame
      map.disparity_px.at(x, y) =
          static_cast<float>(camera.matrix(0, 0) * geometry.baseline * nearness);
      map.unmatched.at(x, y) = 0;
    }
    const MatchedMap own = pair.on_photograph(side, map, 500);
    int known = 0;
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      if (own.unmatched.at(x, y) == 0) {
        ++known;
        EXPECT_NEAR(own.disparity_px.at(x, y), 500 * geometry.baseline / kDepth, 1e-3);
      } else {
        EXPECT_TRUE(std::isnan(own.disparity_px.at(x, y)));
      }
    }
    EXPECT_GT(known, kWidth * kHeight / 3);
  }
}

/// Points in common of two cameras, with noise, a fifth of them wrong.
std::vector<PointMatch> matches_of(const SceneCamera& first, const SceneCamera& second) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> within(-1, 1);
  std::vector<PointMatch> matches;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d point(4 * within(random), 3 * within(random), 9 + 4 * within(random));
    const auto place = [&](const SceneCamera& camera) {
      const Eigen::Vector3d seen = camera.pose.rotation * point + camera.pose.translation;
      const Eigen::Vector2d exact = (camera.lens.matrix * seen).hnormalized();
      return Eigen::Vector2d(exact + 0.1 * Eigen::Vector2d(within(random), within(random)));
    };
    matches.push_back({place(first), place(second)});
    if (i % 5 == 0) {
      matches.back().right += 20 * Eigen::Vector2d(within(random), within(random));
    }
  }
  return matches;
}

TEST(RelativePose, IsCorrectedFromPointsInCommon) {
  const SceneCamera first = camera_at({0, 0, 0});
  const SceneCamera second = camera_at({1, 0, 0}, {1, 2, -3});
  const std::vector<PointMatch> matches = matches_of(first, second);
  const StereoCalibration truth = calibration_of(first, second, kWidth, kHeight);
  StereoCalibration given = truth;
  given.rotation = given.rotation * turn({0.8, 0, 0.5});  // about the baseline and the view
  given.translation = turn({0, 0, 2}) * given.translation;
  const RefinedPose refined = refine_relative_pose(given, matches);
  const Eigen::AngleAxisd error(
      Eigen::Matrix3d(refined.calibration.rotation * truth.rotation.transpose()));
  EXPECT_LT(std::abs(error.angle()), 0.1 * std::numbers::pi / 180);
  EXPECT_NEAR(refined.turned_degrees, std::sqrt(0.64 + 0.25), 0.1);
  EXPECT_NEAR(refined.calibration.baseline(), truth.baseline(), 1e-12);
  EXPECT_GT(refined.inliers, 200);
  EXPECT_LT(refined.rms_px, 0.1);

  EXPECT_NEAR(refined.moved_degrees, 2, 0.3);

  given.rotation = turn({20, 0, 0}) * truth.rotation;
  EXPECT_THAT(error_of([&] { refine_relative_pose(given, matches); }),
              HasSubstr("degrees from the given one"));
  EXPECT_THAT(error_of([&] {
                refine_relative_pose(truth, {matches.begin(), matches.begin() + 9});
              }),
              HasSubstr("expected at least 20"));
}

std::vector<std::string> names(std::size_t count) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < count; ++i) {
    all.push_back(std::to_string(i) + ".png");
  }
  return all;
}

std::vector<SceneEdge> edges_of(const std::vector<SceneCamera>& cameras, int neighbours) {
  return posed_edges(cameras, names(cameras.size()), kWidth, kHeight, neighbours);
}

TEST(PosedEdges, JoinTheNearestInDifferentDirections) {
  std::vector<SceneCamera> grid;
  for (int i = 0; i < 9; ++i) {
    grid.push_back(camera_at({i % 3 + 0.01 * i, i / 3 * 1.1, 0}, {0.3 * i, 0, 0}));
  }
  const std::vector<SceneEdge> edges = edges_of(grid, 4);
  const auto has = [&](int first, int second) {
    return std::ranges::any_of(
        edges, [&](const SceneEdge& e) { return e.first == first && e.second == second; });
  };
  for (const auto& [first, second] : {std::pair{3, 4}, {4, 5}, {1, 4}, {4, 7}, {0, 1}, {0, 3}}) {
    EXPECT_TRUE(has(first, second)) << first << "-" << second;
  }
  EXPECT_FALSE(has(3, 5));  // behind its neighbour
  EXPECT_NEAR(median_length(edges), 1.1, 0.11);
}

TEST(PosedEdges, CamerasThatLookAwayOrForwardHaveNone) {
  EXPECT_THAT(error_of([&] {
                edges_of({camera_at({0, 0, 0}), camera_at({0, 0, 1})}, 4);
              }),
              HasSubstr("0.png: no other camera beside it"));
  EXPECT_THAT(error_of([&] {
                edges_of({camera_at({0, 0, 0}), camera_at({1, 0, 0}, {0, 60, 0})}, 4);
              }),
              HasSubstr("no other camera"));
  EXPECT_THAT(error_of([&] {
                edges_of({camera_at({1, 2, 3}), camera_at({1, 2, 3})}, 4);
              }),
              HasSubstr("0.png and 1.png have cameras at one position"));
  EXPECT_THAT(error_of([&] { edges_of({camera_at({0, 0, 0})}, 4); }), HasSubstr("1 images"));
}

/// A scene seen by some cameras with exact maps, and the sources of a view of them.
class BlendedViews : public testing::Test {
 protected:
  static constexpr double kScale_px = 40;

  BlendedViews() {
    LayeredSceneOptions options;
    options.width_px = kWidth;
    options.height_px = kHeight;
    options.samples_per_side = 2;
    const LayeredScene scene(options, execution_);
    const PosedCamera plain = scene.camera({});
    for (const SceneCamera& placed :
         {camera_at({0, 0, 0}, {0, 0.5, 1}), camera_at({1, 0.1, 0}, {0.3, 0, -1}),
          camera_at({0.5, -0.4, 0.1}), camera_at({0.5, 0, 0.05}, {0.2, 0.1, 0.4}),
          camera_at({2.5, 0, 0})}) {
      PosedCamera camera = plain;
      camera.rotation = placed.pose.rotation;
      camera.translation = placed.pose.translation;
      cameras_.push_back(camera);
      SceneRendering rendering = scene.render(camera, 0);
      images_.push_back(std::move(rendering.image));
      // Disparities of the scene are its focal length / depth.
      DisparityMap map(kWidth, kHeight);
      for (const auto [x, y] : positions_of(kWidth, kHeight)) {
        map.at(x, y) =
            static_cast<float>(rendering.disparity.at(x, y) * kScale_px / scene.focal_length_px());
      }
      maps_.push_back(std::move(map));
    }
  }

  [[nodiscard]] SynthesizedView view_of(const std::vector<std::size_t>& sources,
                                        std::size_t wanted) {
    return view_of(sources, wanted, execution_);
  }
  [[nodiscard]] SynthesizedView view_of(const std::vector<std::size_t>& sources, std::size_t wanted,
                                        Execution& execution) const {
    const PosedCamera& camera = cameras_[wanted];
    std::vector<BlendSource> all;
    for (const std::size_t k : sources) {
      const PosedCamera& own = cameras_[k];
      const CameraPose pose =
          relative_pose({own.rotation, own.translation}, {camera.rotation, camera.translation});
      all.push_back({.image = &images_[k],
                     .disparity_px = maps_[k].view(),
                     .warp = {.homography = camera.matrix * pose.rotation * own.matrix.inverse(),
                              .parallax = camera.matrix * pose.translation / kScale_px},
                     .centre = camera.rotation * own.centre() + camera.translation,
                     .share = 1,
                     .on_first = {}});
    }
    SynthesizedView view;
    BlendedSynthesizer({}, execution)
        .synthesize(all,
                    {.width_px = kWidth,
                     .height_px = kHeight,
                     .ray_of_pixel = camera.matrix.inverse(),
                     .scale_px = kScale_px},
                    view);
    return view;
  }

  [[nodiscard]] double mean_error(const SynthesizedView& view, std::size_t wanted) const {
    const auto& made = std::get<Image<std::uint8_t>>(view.image.pixels);
    const auto& truth = std::get<Image<std::uint8_t>>(images_[wanted].pixels);
    double sum = 0;
    for (const auto [x, y] : positions_of(kWidth * 3, kHeight)) {
      sum += std::abs(made.row(y)[x] - truth.row(y)[x]);
    }
    return sum / (kWidth * kHeight * 3);
  }

  Execution execution_{{.threads = 2}};
  std::vector<PosedCamera> cameras_;
  std::vector<Photograph> images_;
  std::vector<DisparityMap> maps_;
};

TEST_F(BlendedViews, MoreSourcesLeaveFewerHolesAndErrors) {
  const SynthesizedView two = view_of({0, 1}, 3);
  const SynthesizedView three = view_of({0, 1, 2}, 3);
  EXPECT_LT(three.hole_fraction, two.hole_fraction);
  EXPECT_LT(mean_error(three, 3), mean_error(two, 3));
  EXPECT_LT(mean_error(three, 3), 4);
}

TEST_F(BlendedViews, AFarSourceWhoseMapIsOffDoesLittleHarm) {
  const double of_pair = mean_error(view_of({0, 1}, 3), 3);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    maps_[4].at(x, y) += 0.8F;  // below the gradient limit: it is taken for the same surface
  }
  EXPECT_LT(mean_error(view_of({0, 1, 4}, 3), 3), 1.1 * of_pair);
}

TEST_F(BlendedViews, AtAnImageTheViewIsThatImage) {
  EXPECT_LT(mean_error(view_of({0, 1, 2}, 1), 1), 0.05);
}

TEST_F(BlendedViews, DoNotDependOnTheExecution) {
  const SynthesizedView expected = view_of({0, 1, 2}, 3);
  Execution one_thread({.threads = 1});
  const SynthesizedView other = view_of({0, 1, 2}, 3, one_thread);
  const auto& first = std::get<Image<std::uint8_t>>(expected.image.pixels);
  const auto& second = std::get<Image<std::uint8_t>>(other.image.pixels);
  for (int y = 0; y < kHeight; ++y) {
    ASSERT_TRUE(std::equal(first.row(y), first.row(y) + 3 * kWidth, second.row(y))) << y;
  }
}

}  // namespace vantage::posed_cameras_test
