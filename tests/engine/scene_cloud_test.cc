#include "engine/scene_graph/scene_cloud.h"

#include "tests/engine/engine_test.h"

#include <Eigen/Dense>

namespace vantage::scene_cloud_test {

constexpr int kWidth = 61;
constexpr int kHeight = 43;
constexpr double kFocalLength_px = 50;

/// normal · X = 1.
const Eigen::Vector3d kPlane(0.02, -0.03, 0.1);

/// Exact maps of a slanted plane from four cameras, each an edge away from all others.
class PlaneScene : public testing::Test {
 protected:
  PlaneScene() {
    stored_.width_px = kWidth;
    stored_.height_px = kHeight;
    stored_.focal_length_px = kFocalLength_px;
    stored_.unit_length = 1.3;
    add_camera({0, 0, 0}, {0.02, -0.03, 0.1});
    add_camera({1, 0, 0.1}, {-0.01, 0.04, -0.05});
    add_camera({0.1, 1, -0.1}, {0.03, 0.01, 0.2});
    add_camera({1, 1.1, 0}, {0, 0, 0});
    for (int first = 0; first < 4; ++first) {
      for (int second = first + 1; second < 4; ++second) {
        const double length = (camera(first).pose.centre() - camera(second).pose.centre()).norm();
        StoredEdge edge;
        edge.edge = {.first = first, .second = second, .length = length};
        stored_.edges.push_back(edge);
      }
    }
  }

  void add_camera(const Eigen::Vector3d& centre, const Eigen::Vector3d& turn) {
    SceneCamera camera;
    camera.lens.matrix << kFocalLength_px, 0, 30.5, 0, kFocalLength_px, 20, 0, 0, 1;
    camera.pose.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    if (turn.isZero()) {
      camera.pose.rotation.setIdentity();
    }
    camera.pose.translation = -camera.pose.rotation * centre;
    stored_.images.push_back({.file = "", .content = "", .position = {}, .camera = camera});
  }
  [[nodiscard]] const SceneCamera& camera(int vertex) const {
    return *stored_.images[static_cast<std::size_t>(vertex)].camera;
  }

  /// Depth of the plane in a camera.
  [[nodiscard]] double depth(int vertex, int x, int y) const {
    const SceneCamera& of = camera(vertex);
    const Eigen::Vector3d ray =
        of.pose.rotation.transpose() * of.lens.matrix.inverse() * Eigen::Vector3d(x, y, 1);
    return (1 - kPlane.dot(of.pose.centre())) / kPlane.dot(ray);
  }

  [[nodiscard]] SceneVertex vertex(int number) const {
    SceneVertex made;
    Image<std::uint8_t> image(kWidth, kHeight, 3);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      image.at(x, y, 0) = static_cast<std::uint8_t>(number);
      image.at(x, y, 1) = static_cast<std::uint8_t>(x);
      image.at(x, y, 2) = static_cast<std::uint8_t>(y);
    }
    made.image = Photograph{std::move(image)};
    for (const StoredEdge& edge : stored_.edges) {
      if (edge.edge.first != number && edge.edge.second != number) {
        continue;
      }
      SceneEdgeMap map{.neighbour = edge.edge.first + edge.edge.second - number,
                       .length = edge.edge.length,
                       .disparity_px = DisparityMap(kWidth, kHeight),
                       .unmatched = Mask(kWidth, kHeight)};
      for (const auto [x, y] : positions_of(kWidth, kHeight)) {
        const double wrong = number == wrong_vertex_ ? 1.3 : 1;
        map.disparity_px.at(x, y) =
            static_cast<float>(wrong * kFocalLength_px * edge.edge.length / depth(number, x, y));
        map.unmatched.at(x, y) = x >= filled_from_x_ ? 255 : 0;
      }
      made.maps.push_back(std::move(map));
    }
    return made;
  }

  [[nodiscard]] PointCloud cloud(const SceneCloudOptions& options, int threads = 2) const {
    Execution execution({.threads = threads});
    SceneCloudMaker maker(
        stored_, [&](int number) { return vertex(number); }, options, execution);
    while (maker.add_image()) {
    }
    return maker.finish();
  }

  StoredScene stored_;
  int wrong_vertex_ = -1;
  int filled_from_x_ = kWidth;
};

/// Distance of point i from the plane, in its own units.
double distance(const PointCloud& cloud, std::size_t i) {
  const Eigen::Vector3f point(&cloud.positions[3 * i]);
  return std::abs(kPlane.dot(point.cast<double>()) - 1) / kPlane.norm();
}

TEST_F(PlaneScene, PointsAndNormalsAreThoseOfTheSurface) {
  const PointCloud made = cloud({.min_images = 2});
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_LT(distance(made, i), 1e-4 * 10);
    const Eigen::Vector3f normal(&made.normals[3 * i]);
    EXPECT_LT((normal.cast<double>() + kPlane.normalized()).norm(), 1e-3);
    // The colour is that of the pixel that shows the point.
    const SceneCamera& from = camera(made.colours[3 * i]);
    const Eigen::Vector3d point = Eigen::Vector3f(&made.positions[3 * i]).cast<double>();
    const Eigen::Vector2d at =
        (from.lens.matrix * (from.pose.rotation * point + from.pose.translation)).hnormalized();
    EXPECT_NEAR(at.x(), made.colours[3 * i + 1], 1e-3);
    EXPECT_NEAR(at.y(), made.colours[3 * i + 2], 1e-3);
  }
}

/// A pixel becomes a point where no image before shows the same place.
TEST_F(PlaneScene, EverySurfaceBecomesPointsOnce) {
  const PointCloud made = cloud({.min_images = 2});
  std::vector<int> points_of(4, 0);
  for (std::size_t i = 0; i < made.size(); ++i) {
    ++points_of[made.colours[3 * i]];
  }
  for (int vertex = 0; vertex < 4; ++vertex) {
    int expected = 0;
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      const SceneCamera& own = camera(vertex);
      const Eigen::Vector3d point =
          own.pose.rotation.transpose() *
              (own.lens.matrix.inverse() * Eigen::Vector3d(x, y, 1) * depth(vertex, x, y)) +
          own.pose.centre();
      bool is_earlier = false;
      int images = 0;
      for (int other = 0; other < 4; ++other) {
        const SceneCamera& by = camera(other);
        const Eigen::Vector2d at =
            (by.lens.matrix * (by.pose.rotation * point + by.pose.translation)).hnormalized();
        const bool is_seen = std::round(at.x()) >= 0 && std::round(at.x()) < kWidth &&
                             std::round(at.y()) >= 0 && std::round(at.y()) < kHeight;
        images += is_seen ? 1 : 0;
        is_earlier = is_earlier || (is_seen && other < vertex);
      }
      expected += images >= 2 && !is_earlier ? 1 : 0;
    }
    // Half a pixel at a border may be rounded otherwise.
    EXPECT_NEAR(points_of[static_cast<std::size_t>(vertex)], expected, 3) << vertex;
  }
}

TEST_F(PlaneScene, WrongAndFilledDepthsAreLeftOut) {
  wrong_vertex_ = 1;
  filled_from_x_ = 40;
  const PointCloud made = cloud({.min_images = 2});
  ASSERT_GT(made.size(), 1000U);
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_LT(distance(made, i), 0.02);  // beside what is filled, the nearest pixel counts
    EXPECT_NE(made.colours[3 * i], wrong_vertex_);
    EXPECT_LT(made.colours[3 * i + 1], filled_from_x_);
  }
  EXPECT_LT(cloud({.min_images = 3}).size(), made.size());
  EXPECT_THAT(error_of([&] { (void)cloud({.min_images = 4}); }),
              HasSubstr("no point is seen at one depth in 4 images"));
}

TEST_F(PlaneScene, OptionsSelectPoints) {
  const PointCloud made = cloud({.min_images = 2, .max_depth = 9.5, .step_px = 3}, 1);
  const PointCloud same = cloud({.min_images = 2, .max_depth = 9.5, .step_px = 3}, 3);
  EXPECT_EQ(made.positions, same.positions);
  EXPECT_EQ(made.normals, same.normals);
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_EQ(made.colours[3 * i + 1] % 3, 0);
    EXPECT_EQ(made.colours[3 * i + 2] % 3, 0);
    const SceneCamera& from = camera(made.colours[3 * i]);
    const Eigen::Vector3d point = Eigen::Vector3f(&made.positions[3 * i]).cast<double>();
    EXPECT_LT((from.pose.rotation * point + from.pose.translation).z(), 9.5 + 1e-4);
  }
  EXPECT_LT(made.size(), cloud({.min_images = 2}).size() / 5);
  EXPECT_THAT(error_of([&] { (void)cloud({.min_images = 0}); }), HasSubstr("min-images is 0"));
  EXPECT_THAT(error_of([&] { (void)cloud({.tolerance_px = 0}); }),
              HasSubstr("depth-tolerance is 0"));
  EXPECT_THAT(error_of([&] { (void)cloud({.max_depth = -1}); }), HasSubstr("max-depth is -1"));
  EXPECT_THAT(error_of([&] { (void)cloud({.step_px = 0}); }), HasSubstr("cloud-step is 0"));
  stored_.images[0].camera.reset();
  EXPECT_THAT(error_of([&] { (void)cloud({}); }), HasSubstr("the scene has no poses"));
}

}  // namespace vantage::scene_cloud_test
