
#include <Eigen/Dense>

#include "engine/execution.h"
#include "engine/reprojection/map_camera.h"
#include "engine/reprojection/point_cloud.h"
#include "tests/engine/engine_test.h"

namespace vantage::reprojection_test {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A rectified pair with all that may differ: fx and fy, cx of both images.
RectifiedPair some_pair() {
  RectifiedPair pair;
  pair.width_px = 61;
  pair.height_px = 47;
  pair.baseline = 193;
  pair.doffs_px = 12.5;
  pair.left.matrix << 70, 0, 28.5, 0, 71, 21.25, 0, 0, 1;
  pair.right.matrix = pair.left.matrix;
  pair.right.matrix(0, 2) += 12.5;
  pair.left.rotation =
      Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  return pair;
}

struct Plane {
  Eigen::Vector3d normal;
  double distance;
};

/// Where the ray from `centre` meets normal · X = distance.
Eigen::Vector3d meets(const Plane& plane, const Eigen::Vector3d& centre,
                      const Eigen::Vector3d& ray) {
  return centre + ray * (plane.distance - plane.normal.dot(centre)) / plane.normal.dot(ray);
}

/// Exact maps of a slanted plane: each point is where a ray meets the plane, in metres.
TEST(Reprojection, OfExactMapsIsExact) {
  Execution execution(ExecutionOptions{});
  const RectifiedPair pair = some_pair();
  const Plane plane{Eigen::Vector3d(0.3, -0.2, 1).normalized(), 2.5};
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const Eigen::Matrix3d& matrix = pair.camera(side).matrix;
    const Eigen::Vector3d centre(side == Side::kLeft ? 0 : 0.193, 0, 0);
    DisparityMap map(61, 47);
    for (const auto [x, y] : positions_of(map)) {
      const Eigen::Vector3d point =
          meets(plane, centre, matrix.inverse() * Eigen::Vector3d(x, y, 1));
      // Seen in both images, by projection.
      const double x_left = 70 * point.x() / point.z() + 28.5;
      const double x_right = 70 * (point.x() - 0.193) / point.z() + 41;
      map.at(x, y) = static_cast<float>(x_left - x_right);
    }
    const MapCamera camera = map_camera(pair, side, 0.001);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(-1, 0.5, 2).normalized()).toRotationMatrix();
    const Eigen::Vector3d place(4, -7, 1.5);
    Image<float> points;
    Image<float> in_the_world;
    reproject(map.view(), camera, kNoMaxDepth, execution, points);
    reproject(map.view(), in_world(camera, turn, place, pair.left.rotation), kNoMaxDepth, execution,
              in_the_world);
    Image<float> depths;
    depth_map(map.view(), camera.scale, kNoMaxDepth, execution, depths);
    for (const auto [x, y] : positions_of(map)) {
      const Eigen::Vector3d truth =
          meets(plane, centre, matrix.inverse() * Eigen::Vector3d(x, y, 1));
      const Eigen::Vector3d point(points.at(x, y, 0), points.at(x, y, 1), points.at(x, y, 2));
      EXPECT_LE((point - truth).norm(), 1e-6 * truth.norm());
      EXPECT_FLOAT_EQ(depths.at(x, y), points.at(x, y, 2));
      const Eigen::Vector3d world(in_the_world.at(x, y, 0), in_the_world.at(x, y, 1),
                                  in_the_world.at(x, y, 2));
      const Eigen::Vector3d true_world = turn * (pair.left.rotation.transpose() * truth) + place;
      EXPECT_LE((world - true_world).norm(), 1e-6 * true_world.norm());
    }
  }
}

TEST(Reprojection, KnowsInfinityAndTheMaximum) {
  Execution execution(ExecutionOptions{});
  DisparityMap map(6, 1);
  const float disparities[] = {10, 0, -3, kNan, std::numeric_limits<float>::infinity(), 1};
  std::copy(std::begin(disparities), std::end(disparities), map.row(0));
  const DepthScale scale{.focal_length_px = 100, .baseline = 0.5};
  Image<float> depths;
  depth_map(map.view(), scale, 49, execution, depths);
  EXPECT_EQ(depths.at(0, 0), 5);
  for (int x = 1; x < 6; ++x) {
    EXPECT_TRUE(std::isnan(depths.at(x, 0))) << x;
  }
  depth_map(map.view(), scale, 50, execution, depths);
  EXPECT_EQ(depths.at(5, 0), 50);
}

/// A square of 4×3 pixels before a background, 12×9 pixels.
class Clouds : public testing::Test {
 protected:
  Clouds() {
    map_.fill(2);
    for (int y = 3; y < 6; ++y) {
      std::fill_n(map_.row(y) + 4, 4, 9.0F);
    }
    unmatched_.fill(0);
    confidence_.fill(0.5F);
    source_ = {.disparity_px = map_.view(),
               .colours = &image_,
               .unmatched = unmatched_.view(),
               .confidence = confidence_.view(),
               .camera = {.scale = {.focal_length_px = 10, .baseline = 1}}};
    source_.camera.matrix << 10, 0, 5.5, 0, 10, 4, 0, 0, 1;
  }
  [[nodiscard]] std::size_t points(const CloudOptions& options) {
    return point_cloud(source_, options, execution_).size();
  }

  Execution execution_{ExecutionOptions{}};
  DisparityMap map_{12, 9};
  Mask unmatched_{12, 9};
  Image<float> confidence_{12, 9};
  Photograph image_ = noise<std::uint8_t>(12, 9, 3);
  CloudSource source_;
};

TEST_F(Clouds, LeaveOutOutlines) {
  EXPECT_EQ(points({.keeps_outlines = true}), 12U * 9);
  // The rim of the square, 10 of its 12 pixels, and the 14 of the background beside it.
  EXPECT_EQ(points({}), 12U * 9 - 10 - 14);
  EXPECT_EQ(points({.gradient_limit_px = 7}), 12U * 9);
  map_.at(0, 0) = kNan;  // unknown neighbours do not count
  EXPECT_EQ(points({}), 12U * 9 - 10 - 14 - 1);
}

TEST_F(Clouds, LeaveOutGuessesAndDoubts) {
  const CloudOptions all{.keeps_outlines = true};
  unmatched_.at(11, 8) = 255;
  EXPECT_EQ(points(all), 12U * 9 - 1);
  EXPECT_EQ(points({.keeps_filled = true, .keeps_outlines = true}), 12U * 9);
  confidence_.at(0, 0) = 0.25F;
  confidence_.at(1, 0) = kNan;
  EXPECT_EQ(points({.min_confidence = 0.5, .keeps_outlines = true}), 12U * 9 - 3);
  EXPECT_EQ(points({.max_depth = 4, .keeps_outlines = true}), 12U);
  EXPECT_EQ(points({.step_px = 5, .keeps_outlines = true}), 3U * 2);
}

TEST_F(Clouds, HaveColoursAndConfidenceOfTheirPixels) {
  const PointCloud cloud = point_cloud(
      source_, {.step_px = 4, .keeps_outlines = true, .with_confidence = true}, execution_);
  ASSERT_EQ(cloud.size(), 9U);
  ASSERT_EQ(cloud.confidence.size(), 9U);
  const auto& pixels = std::get<Image<std::uint8_t>>(image_.pixels);
  for (std::size_t i = 0; i < 9; ++i) {
    const int x = 4 * static_cast<int>(i % 3);
    const int y = 4 * static_cast<int>(i / 3);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(cloud.colours[3 * i + static_cast<std::size_t>(c)], pixels.at(x, y, c));
    }
    EXPECT_FLOAT_EQ(cloud.positions[3 * i + 2], 10 / map_.at(x, y));
    EXPECT_FLOAT_EQ(cloud.positions[3 * i], (static_cast<float>(x) - 5.5F) / map_.at(x, y));
  }
  image_ = noise<std::uint16_t>(12, 9, 1);
  const PointCloud grey = point_cloud(source_, {}, execution_);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    EXPECT_EQ(grey.colours[3 * i], grey.colours[3 * i + 2]);
  }
}

/// The front of each triangle faces the camera; none connects the square with its background.
TEST_F(Clouds, BecomeSurfacesWithCuts) {
  const TriangleMesh mesh = triangle_mesh(source_, {.keeps_outlines = true}, execution_);
  // Two per square of neighbours within the square and within the background.
  const int background = 11 * 8 - 5 * 4;
  EXPECT_EQ(mesh.triangles.size() / 3, 2U * static_cast<unsigned>(3 * 2 + background));
  EXPECT_EQ(mesh.vertices.size(), 12U * 9);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    Eigen::Vector3f corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const float* p =
          &mesh.vertices.positions[3 * static_cast<std::size_t>(mesh.triangles[i + k])];
      corner[k] = {p[0], p[1], p[2]};
    }
    EXPECT_EQ(corner[0].z(), corner[1].z());
    EXPECT_EQ(corner[0].z(), corner[2].z());
    EXPECT_LT((corner[1] - corner[0]).cross(corner[2] - corner[0]).z(), 0);
  }
  // Three of four corners make one triangle; steps do not bridge what they skip.
  map_.fill(2);
  map_.at(0, 0) = map_.at(11, 8) = map_.at(11, 0) = map_.at(0, 8) = kNan;
  EXPECT_EQ(triangle_mesh(source_, {}, execution_).triangles.size() / 3, 2U * 11 * 8 - 4);
  map_.at(3, 1) = kNan;
  EXPECT_EQ(
      triangle_mesh(source_, {.step_px = 2, .keeps_outlines = true}, execution_).triangles.size() /
          3,
      2U * 5 * 4 - 1 - 1 - 2);
}

TEST_F(Clouds, AreTheSameForAnyExecution) {
  Execution serial(ExecutionOptions{.threads = 1});
  EXPECT_EQ(point_cloud(source_, {}, serial).positions,
            point_cloud(source_, {}, execution_).positions);
}

TEST_F(Clouds, SayWhatIsWrong) {
  const auto error = [&](const CloudOptions& options) {
    return error_of([&] { (void)point_cloud(source_, options, execution_); });
  };
  EXPECT_EQ(error({.step_px = 0}), "cloud-step is 0, expected a number from 1 to 1024");
  EXPECT_EQ(error({.gradient_limit_px = 0}),
            "cloud-gradient-limit is 0, expected a number above 0");
  EXPECT_EQ(error({.max_depth = -1}), "max-depth is -1, expected a number above 0");
  EXPECT_EQ(error({.min_confidence = 0.75}).substr(0, 19), "the cloud is empty:");
  EXPECT_EQ(
      error_of([&] { (void)triangle_mesh(source_, {.step_px = 100}, execution_); }).substr(0, 18),
      "the mesh is empty:");
  const Photograph other = noise<std::uint8_t>(11, 9, 3);
  source_.colours = &other;
  EXPECT_EQ(error({}), "the image is 11x9 but the disparity map is 12x9, expected equal sizes");
}

}  // namespace vantage::reprojection_test
