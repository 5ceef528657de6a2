#include "engine/generation/layered_scene.h"

#include "tests/engine/engine_test.h"

#include <Eigen/Dense>

namespace vantage::layered_scene_test {

constexpr SceneView kLeft{0, 0};
constexpr SceneView kRight{1, 0};

LayeredSceneOptions small(int width = 80, int height = 60) {
  LayeredSceneOptions options;
  options.width_px = width;
  options.height_px = height;
  options.samples_per_side = 1;
  return options;
}

const Image<std::uint8_t>& bytes_of(const SceneRendering& rendering) {
  return std::get<Image<std::uint8_t>>(rendering.image.pixels);
}

template <typename T>
bool equal(const Image<T>& a, const Image<T>& b) {
  for (int y = 0; y < a.height(); ++y) {
    if (std::memcmp(a.row(y), b.row(y), sizeof(T) * a.width() * a.channels()) != 0) {
      return false;
    }
  }
  return a.width() == b.width() && a.height() == b.height();
}

double mean_difference(const SceneRendering& a, const SceneRendering& b) {
  double sum = 0;
  for (const auto [x, y] : positions_of(3 * a.image.width(), a.image.height())) {
    sum += std::abs(bytes_of(a).row(y)[x] - bytes_of(b).row(y)[x]);
  }
  return sum / (3.0 * a.image.width() * a.image.height());
}

// Disparity of one channel of colours between pixel centres of a row.
double interpolated(const Image<std::uint8_t>& image, double x, int y, int channel) {
  const double inside = std::clamp(x, 0.0, image.width() - 1.0);
  const int x0 = std::min(static_cast<int>(inside), std::max(0, image.width() - 2));
  const int x1 = std::min(x0 + 1, image.width() - 1);
  return image.at(x0, y, channel) +
         (inside - x0) * (image.at(x1, y, channel) - image.at(x0, y, channel));
}

TEST(LayeredScene, DisparityIsFocalLengthOverDepth) {
  const LayeredScene scene(small(), execution());
  const double f = scene.focal_length_px();
  for (const SceneView view : {kLeft, kRight, SceneView{0.37, -0.4}}) {
    const SceneRendering rendering = scene.render(view, 7);
    for (int y = 0; y < 60; y += 3) {
      for (int x = 0; x < 80; x += 3) {
        const ScenePoint point = scene.point_at(view, 7, x, y);
        ASSERT_FLOAT_EQ(rendering.disparity.at(x, y), static_cast<float>(f / point.z));
        // The point projects to where it was seen.
        ASSERT_NEAR(39.5 + f * (point.x - view.x) / point.z, x, 1e-9);
        ASSERT_NEAR(29.5 + f * (point.y - view.y) / point.z, y, 1e-9);
      }
    }
  }
}

// Equation (3.5): p − d · (B − A) is the same surface point in view B, or B sees a nearer one.
TEST(LayeredScene, WarpedPixelsMeetTheSameSurfacePointUnlessOccluded) {
  const LayeredScene scene(small(), execution());
  struct Pair {
    SceneView from, in;
  };
  for (const Pair pair : {Pair{kLeft, kRight}, Pair{kRight, kLeft}, Pair{{0.5, 0}, {2, 0}},
                          Pair{kLeft, {0.3, 0.6}}, Pair{{-1, 0.5}, kRight}}) {
    for (const int frame : {0, 41}) {
      const SceneRendering rendering = scene.render(pair.from, frame);
      const Mask occluded = scene.occlusion(pair.from, pair.in, frame);
      int visible = 0;
      int hidden = 0;
      for (const auto [x, y] : positions_of(80, 60)) {
        const ScenePoint point = scene.point_at(pair.from, frame, x, y);
        const double disparity = scene.focal_length_px() / point.z;
        const double x_in = x - disparity * (pair.in.x - pair.from.x);
        const double y_in = y - disparity * (pair.in.y - pair.from.y);
        const bool in_frame = x_in >= -0.5 && x_in < 79.5 && y_in >= -0.5 && y_in < 59.5;
        const ScenePoint met = scene.point_at(pair.in, frame, x_in, y_in);
        if (occluded.at(x, y) == 0) {
          ++visible;
          ASSERT_TRUE(in_frame);
          ASSERT_EQ(met.surface, point.surface) << x << ' ' << y;
          ASSERT_NEAR(met.x, point.x, 1e-6 * point.z);
          ASSERT_NEAR(met.y, point.y, 1e-6 * point.z);
          ASSERT_NEAR(met.z, point.z, 1e-6 * point.z);
        } else if (in_frame) {
          ++hidden;
          ASSERT_LT(met.z, point.z);
        }
      }
      EXPECT_GT(visible, 3000);
      EXPECT_GT(hidden, 20);
    }
  }
}

// Occlusion once more, without rays: a point is hidden when the other view's disparity map is
// clearly nearer at its place. Rounding to pixels leaves doubt along edges.
TEST(LayeredScene, OcclusionAgreesWithDisparityMaps) {
  const LayeredScene scene(small(320, 240), execution());
  const SceneRendering left = scene.render(kLeft, 3);
  const SceneRendering right = scene.render(kRight, 3);
  const Mask occluded = scene.occlusion(kLeft, kRight, 3);
  int agreements = 0;
  int hidden = 0;
  for (const auto [x, y] : positions_of(320, 240)) {
    const float disparity = left.disparity.at(x, y);
    const int partner = static_cast<int>(std::lround(static_cast<float>(x) - disparity));
    const bool seen =
        partner >= 0 && partner < 320 && right.disparity.at(partner, y) < disparity + 0.5F;
    agreements += seen == (occluded.at(x, y) == 0) ? 1 : 0;
    hidden += seen ? 0 : 1;
  }
  EXPECT_GT(hidden, 2000);
  EXPECT_GT(agreements, 320 * 240 * 0.99);
}

TEST(LayeredScene, NothingIsOccludedInItsOwnView) {
  const LayeredScene scene(small(61, 47), execution());
  const Mask occluded = scene.occlusion(kRight, kRight, 5);
  for (int y = 0; y < 47; ++y) {
    EXPECT_EQ(std::count(occluded.row(y), occluded.row(y) + 61, 0), 61);
  }
}

TEST(LayeredScene, ViewsShowTheSameColoursAtWarpedPositions) {
  LayeredSceneOptions options = small(320, 240);
  options.samples_per_side = 2;
  const LayeredScene scene(options, execution());
  const SceneRendering left = scene.render(kLeft, 20);
  for (const double view_x : {0.5, 1.0}) {
    const SceneRendering other = scene.render({view_x, 0}, 20);
    const Mask occluded = scene.occlusion(kLeft, {view_x, 0}, 20);
    // Mean differences with the true disparity and with one that is two pixels off.
    double sums[2] = {};
    int samples = 0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 1; x + 1 < 320; ++x) {
        const float disparity = left.disparity.at(x, y);
        const bool edge = std::abs(left.disparity.at(x - 1, y) - disparity) > 0.5F ||
                          std::abs(left.disparity.at(x + 1, y) - disparity) > 0.5F;
        if (occluded.at(x, y) != 0 || edge) {
          continue;
        }
        for (int c = 0; c < 3; ++c) {
          const double here = bytes_of(left).at(x, y, c);
          const double there = x - disparity * view_x;
          sums[0] += std::abs(here - interpolated(bytes_of(other), there, y, c));
          sums[1] += std::abs(here - interpolated(bytes_of(other), there - 2, y, c));
        }
        ++samples;
      }
    }
    EXPECT_GT(samples, 320 * 240 * 0.8);
    EXPECT_LT(sums[0] / (3.0 * samples), 2);
    EXPECT_GT(sums[1] / (3.0 * samples), 8) << "there is texture to match";
  }
}

// Each board is a plane in disparity space; two of them face the cameras.
TEST(LayeredScene, BoardsAreFlatAndOfOneColour) {
  LayeredSceneOptions options = small(160, 120);
  options.has_boards = true;
  const LayeredScene scene(options, execution());
  for (const SceneView view : {kLeft, kRight}) {
    const SceneRendering rendering = scene.render(view, 5);
    struct Board {
      Eigen::Matrix3d normal_equations = Eigen::Matrix3d::Zero();
      Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
      std::vector<Eigen::Vector3d> pixels;  // x, y, disparity
      std::array<std::uint8_t, 3> colour = {};
    };
    std::map<int, Board> boards;
    for (const auto [x, y] : positions_of(160, 120)) {
      if (rendering.uniform.at(x, y) == 0) {
        continue;
      }
      Board& board = boards[scene.point_at(view, 5, x, y).surface];
      const Eigen::Vector3d at(x, y, 1);
      const auto disparity = static_cast<double>(rendering.disparity.at(x, y));
      board.normal_equations += at * at.transpose();
      board.right_side += disparity * at;
      board.pixels.emplace_back(x, y, disparity);
      for (int c = 0; c < 3; ++c) {
        const std::uint8_t level = bytes_of(rendering).at(x, y, c);
        auto& of_board = board.colour[static_cast<std::size_t>(c)];
        of_board = board.pixels.size() == 1 ? level : of_board;
        ASSERT_EQ(level, of_board) << x << ' ' << y;
      }
    }
    ASSERT_EQ(boards.size(), 4U);
    int slanted = 0;
    for (const auto& [surface, board] : boards) {
      EXPECT_GT(board.pixels.size(), 500U);
      const Eigen::Vector3d plane = board.normal_equations.ldlt().solve(board.right_side);
      for (const Eigen::Vector3d& pixel : board.pixels) {
        ASSERT_NEAR(plane.dot(Eigen::Vector3d(pixel.x(), pixel.y(), 1)), pixel.z(), 1e-4);
      }
      slanted += plane.head<2>().norm() > 0.01 ? 1 : 0;
    }
    EXPECT_EQ(slanted, 2);
  }
}

// Distance of the worst point from the best plane, relative to the extent of the points.
double planarity(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    mean += point / static_cast<double>(points.size());
  }
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  double extent = 0;
  for (const Eigen::Vector3d& point : points) {
    scatter += (point - mean) * (point - mean).transpose();
    extent = std::max(extent, (point - mean).norm());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  double worst = 0;
  for (const Eigen::Vector3d& point : points) {
    worst = std::max(worst, std::abs(normal.dot(point - mean)));
  }
  return worst / extent;
}

// The same for the best sphere: |p|² = 2 c·p + (r² − |c|²) is linear in what is not known.
double sphericity(const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d origin = points.front();
  Eigen::MatrixXd system(points.size(), 4);
  Eigen::VectorXd squares(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d point = points[i] - origin;
    const auto row = static_cast<Eigen::Index>(i);
    system.row(row) << 2 * point.transpose(), 1;
    squares[row] = point.squaredNorm();
  }
  const Eigen::Vector4d solution = system.colPivHouseholderQr().solve(squares);
  const Eigen::Vector3d centre = solution.head<3>();
  const double radius = std::sqrt(solution[3] + centre.squaredNorm());
  double worst = 0;
  for (const Eigen::Vector3d& point : points) {
    worst = std::max(worst, std::abs((point - origin - centre).norm() - radius));
  }
  return worst / radius;
}

TEST(LayeredScene, SurfacesAreExactPlanesSpheresAndOtherCurves) {
  const LayeredScene scene(small(), execution());
  std::map<int, std::vector<Eigen::Vector3d>> points;
  for (const SceneView view : {kLeft, SceneView{1.5, 0.2}}) {
    for (const auto [x, y] : positions_of(160, 120)) {
      const ScenePoint point = scene.point_at(view, 11, x / 2.0, y / 2.0);
      points[point.surface].emplace_back(point.x, point.y, point.z);
    }
  }
  EXPECT_EQ(points.size(), 11U);
  int planes = 0;
  int spheres = 0;
  int others = 0;
  for (const auto& [surface, list] : points) {
    ASSERT_GT(list.size(), 20U);
    if (planarity(list) < 1e-9) {
      ++planes;
      // Slanted: depth varies over the plane.
      const auto [nearest, farthest] = std::minmax_element(
          list.begin(), list.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
      EXPECT_GT(farthest->z() - nearest->z(), 0.1);
    } else if (sphericity(list) < 1e-9) {
      ++spheres;
    } else {
      ++others;
    }
  }
  EXPECT_EQ(planes, 7);  // floor, three cards, three bars
  EXPECT_EQ(spheres, 2);
  EXPECT_EQ(others, 2);  // wall and column
}

TEST(LayeredScene, DisparitiesStayInTheirRange) {
  LayeredSceneOptions narrow = small(70, 70);
  narrow.far_disparity_px = 6;
  narrow.near_disparity_px = 9;
  for (const LayeredSceneOptions& options : {small(), small(50, 90), narrow}) {
    const LayeredScene scene(options, execution());
    float lowest = 1e9F;
    float highest = 0;
    for (int frame = 0; frame < 120; frame += 12) {
      const SceneRendering rendering = scene.render({frame / 120.0, 0}, frame);
      for (int y = 0; y < options.height_px; ++y) {
        const float* row = rendering.disparity.row(y);
        lowest = std::min(lowest, *std::min_element(row, row + options.width_px));
        highest = std::max(highest, *std::max_element(row, row + options.width_px));
      }
    }
    const double far = options.far_disparity_or_default();
    const double near = options.near_disparity_or_default();
    EXPECT_GE(lowest, far);
    EXPECT_LE(highest, near);
    EXPECT_LT(lowest, far + 0.1 * (near - far)) << "the range is made use of";
    EXPECT_GT(highest, far + 0.8 * (near - far));
  }
}

TEST(LayeredScene, SameForAnyExecution) {
  LayeredSceneOptions options = small(67, 53);
  options.noise_sigma = 3;
  const LayeredScene expected(options, execution());
  const SceneRendering rendering = expected.render({0.4, 0}, 9);
  const Mask occluded = expected.occlusion(kLeft, kRight, 9);
  for (const auto executor : {scheduler::ExecutorKind::kSerial, scheduler::ExecutorKind::kOpenMp,
                              scheduler::ExecutorKind::kTbb}) {
    Execution execution({.threads = 3, .executor = executor});
    const LayeredScene scene(options, execution);
    const SceneRendering again = scene.render({0.4, 0}, 9);
    EXPECT_TRUE(equal(bytes_of(again), bytes_of(rendering)));
    EXPECT_TRUE(equal(again.disparity, rendering.disparity));
    EXPECT_TRUE(equal(scene.occlusion(kLeft, kRight, 9), occluded));
  }
}

TEST(LayeredScene, MovesSmoothlyAndPeriodically) {
  LayeredSceneOptions options = small();
  options.frames_per_cycle = 60;
  const LayeredScene scene(options, execution());
  const SceneRendering first = scene.render(kLeft, 0);
  EXPECT_TRUE(equal(bytes_of(first), bytes_of(scene.render(kLeft, 60))));
  const double step = mean_difference(first, scene.render(kLeft, 1));
  EXPECT_GT(step, 0);
  EXPECT_GT(mean_difference(first, scene.render(kLeft, 15)), 2 * step);
}

TEST(LayeredScene, RightCameraGainAndNoise) {
  LayeredSceneOptions options = small();
  const SceneRendering plain = LayeredScene(options, execution()).render(kRight, 0);
  options.right_gain = 0.8;
  options.right_offset = 10;
  const LayeredScene dimmed(options, execution());
  const SceneRendering right = dimmed.render(kRight, 0);
  for (const auto [x, y] : positions_of(80, 60)) {
    ASSERT_NEAR(bytes_of(right).at(x, y, 1), 0.8 * bytes_of(plain).at(x, y, 1) + 10, 1);
  }
  EXPECT_TRUE(equal(bytes_of(dimmed.render(kLeft, 0)),
                    bytes_of(LayeredScene(small(), execution()).render(kLeft, 0))));

  options = small();
  options.noise_sigma = 4;
  const LayeredScene noisy(options, execution());
  const SceneRendering noisy_right = noisy.render(kRight, 0);
  // E|n| = σ √(2/π); rounding and the rare clipping change it little.
  EXPECT_NEAR(mean_difference(noisy_right, plain), 4 * std::sqrt(2 / std::acos(-1.0)), 0.2);
  EXPECT_TRUE(equal(noisy_right.disparity, plain.disparity));
  EXPECT_TRUE(equal(bytes_of(noisy_right), bytes_of(noisy.render(kRight, 0))));
}

TEST(LayeredScene, SeedsChangeTexturesOnly) {
  LayeredSceneOptions options = small();
  const SceneRendering one = LayeredScene(options, execution()).render(kLeft, 0);
  options.seed = 2;
  const SceneRendering two = LayeredScene(options, execution()).render(kLeft, 0);
  EXPECT_GT(mean_difference(one, two), 5);
  EXPECT_TRUE(equal(one.disparity, two.disparity));
}

TEST(LayeredScene, AwkwardSizes) {
  struct Size {
    int width, height;
  };
  for (const Size size : {Size{1, 1}, {1, 31}, {37, 1}, {2, 3}, {13, 101}}) {
    LayeredSceneOptions options = small(size.width, size.height);
    options.samples_per_side = 2;
    const LayeredScene scene(options, execution());
    const SceneRendering rendering = scene.render({0.5, 0}, 0);
    EXPECT_EQ(rendering.image.width(), size.width);
    EXPECT_EQ(rendering.image.height(), size.height);
    EXPECT_EQ(rendering.image.channels(), 3);
    for (const auto [x, y] : positions_of(size.width, size.height)) {
      ASSERT_TRUE(std::isfinite(rendering.disparity.at(x, y)));
      ASSERT_GT(rendering.disparity.at(x, y), 0);
    }
    EXPECT_EQ(scene.occlusion(kLeft, kRight, 0).width(), size.width);
  }
}

TEST(LayeredScene, RejectsWrongOptions) {
  const auto with = [](auto change) {
    LayeredSceneOptions options = small();
    change(options);
    return options;
  };
  using Options = LayeredSceneOptions;
  for (const Options& wrong :
       {with([](Options& o) { o.width_px = 0; }), with([](Options& o) { o.height_px = 16385; }),
        with([](Options& o) { o.far_disparity_px = 0; }),
        with([](Options& o) { o.near_disparity_px = 1.4; }),
        with([](Options& o) { o.samples_per_side = 9; }),
        with([](Options& o) { o.frames_per_cycle = 0; }),
        with([](Options& o) { o.noise_sigma = std::nan(""); }),
        with([](Options& o) { o.right_gain = 0; })}) {
    EXPECT_THROW(LayeredScene(wrong, execution()), UsageError);
  }
  const LayeredScene scene(small(), execution());
  EXPECT_THROW((void)scene.render(kLeft, -1), UsageError);
  EXPECT_THROW((void)scene.render({std::nan(""), 0}, 0), UsageError);
  EXPECT_THROW((void)scene.occlusion(kLeft, {0, 17}, 0), UsageError);
}

// From one place everything is seen along the same rays, whatever way the camera is turned.
TEST(LayeredScene, ATurnedCameraSeesTheSamePoints) {
  const LayeredScene scene({.width_px = 97, .height_px = 61}, execution());
  const SceneView view{0.5, -0.25};
  PosedCamera turned = scene.camera(view);
  turned.matrix << 140, 1.5, 30, 0, 130, 22, 0, 0, 1;
  turned.rotation = (Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(-0.15, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
  turned.translation = -turned.rotation * Eigen::Vector3d(0.5, -0.25, 0);
  turned.width_px = 83;
  turned.height_px = 47;
  const SceneRendering rendering = scene.render(turned, 3);
  ASSERT_EQ(rendering.disparity.width(), 83);
  ASSERT_EQ(rendering.disparity.height(), 47);
  const Mask hidden = scene.occlusion(turned, scene.camera(view), 3);
  for (const auto [x, y] : positions_of(83, 47)) {
    const Eigen::Vector3d ray = turned.matrix.inverse() * Eigen::Vector3d(x, y, 1);
    const double depth = scene.focal_length_px() / rendering.disparity.at(x, y);
    const Eigen::Vector3d relative = depth * (turned.rotation.transpose() * ray);
    const Eigen::Vector2d position(
        (97 - 1) / 2.0 + scene.focal_length_px() * relative.x() / relative.z(),
        (61 - 1) / 2.0 + scene.focal_length_px() * relative.y() / relative.z());
    const ScenePoint point = scene.point_at(view, 3, position.x(), position.y());
    EXPECT_NEAR(point.x - 0.5, relative.x(), 1e-4 * depth);
    EXPECT_NEAR(point.y + 0.25, relative.y(), 1e-4 * depth);
    EXPECT_NEAR(point.z, relative.z(), 1e-4 * depth);
    const bool is_in_frame =
        position.x() >= -0.5 && position.x() < 96.5 && position.y() >= -0.5 && position.y() < 60.5;
    EXPECT_EQ(hidden.at(x, y), is_in_frame ? 0 : 255) << x << ' ' << y;
  }
}

TEST(LayeredScene, IsBlackAndUnknownWhereACameraLooksPastIt) {
  const LayeredScene scene({.width_px = 33, .height_px = 21}, execution());
  PosedCamera backward = scene.camera({0, 0});
  backward.rotation = Eigen::AngleAxisd(3.14, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const SceneRendering rendering = scene.render(backward, 0);
  const auto& image = std::get<Image<std::uint8_t>>(rendering.image.pixels);
  EXPECT_TRUE(std::isnan(rendering.disparity.at(16, 3)));
  EXPECT_EQ(image.at(16, 3, 0), 0);
}

}  // namespace vantage::layered_scene_test
