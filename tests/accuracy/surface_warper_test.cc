#include "engine/synthesis/pair_warpers.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/synthesis/surface_map.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/every_execution.h"
#include "tests/engine/synthesis_pair.h"
#include "tests/kernels/projection_cases.h"

namespace vantage::surface_warper_test {

/// A pair of ideal cameras, principal point in the middle of their images.
RectifiedPair ideal_pair(int width, int height, double focal_length_px) {
  RectifiedPair pair;
  pair.width_px = width;
  pair.height_px = height;
  pair.left.matrix << focal_length_px, 0, (width - 1) / 2.0, 0, focal_length_px, (height - 1) / 2.0,
      0, 0, 1;
  pair.right = pair.left;
  pair.baseline = 1;
  return pair;
}

/// A camera at `centre` (baselines), turned about Z, Y and X, of the images' size.
PosedCamera turned_camera(const RectifiedPair& pair, const Eigen::Vector3d& centre, double roll,
                          double yaw, double pitch, double zoom) {
  PosedCamera camera;
  camera.matrix = pair.left.matrix;
  camera.matrix.topLeftCorner<2, 2>() *= zoom;
  camera.rotation = (Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
  camera.translation = -camera.rotation * centre;
  camera.width_px = pair.width_px;
  camera.height_px = pair.height_px;
  return camera;
}

using Pair = SynthesisPair;

DisparityMap random_map(std::mt19937& random, int width, int height) {
  DisparityMap map(width, height);
  const std::vector<float> values = kernels::random_map(random, width, height);
  for (int y = 0; y < height; ++y) {
    std::copy_n(values.begin() + y * width, width, map.row(y));
  }
  return map;
}

template <typename T>
Pair random_pair(std::mt19937& random, int width, int height, int channels) {
  return random_synthesis_pair<T>(random, width, height, channels, 1,
                                  [&] { return random_map(random, width, height); });
}

std::vector<NewView> views_of(int width, int height) {
  const RectifiedPair pair = ideal_pair(width, height, 1.2 * width);
  return {baseline_view(0.5, 0.3, width, height), baseline_view(-0.2, -1.3, width, height),
          camera_view(pair, turned_camera(pair, {0.4, 0.2, 0.1}, 0.1, 0.05, -0.03, 1)),
          camera_view(pair, turned_camera(pair, {0.8, -0.4, -0.5}, 1.4, 0, 0.1, 1.8)),
          camera_view(pair, turned_camera(pair, {0.3, 0.1, 0}, 0.3, 0, 0, 0.5))};
}

// Tiles that cannot reach a band are skipped: the result is that of looking at every row.
TEST(SurfaceMap, MissesNothing) {
  std::mt19937 random(1);
  Execution execution({.threads = 3, .executor = scheduler::ExecutorKind::kOpenMp});
  for (kernels::ViewProjection view : kernels::projection_cases()) {
    for (const auto& [width, height] : {std::pair{1, 1}, {150, 97}, {64, 16}, {65, 17}, {3, 200}}) {
      DisparityMap map = random_map(random, width, height);
      for (int n = 0; n < 20; ++n) {
        map.at(static_cast<int>(random() % static_cast<unsigned>(width)),
               static_cast<int>(random() % static_cast<unsigned>(height))) =
            static_cast<float>(random() % 100);
      }
      const int view_width = 170;
      const int view_height = 210;
      Image<float> expected(view_width, view_height);
      expected.fill(-std::numeric_limits<float>::infinity());
      // What is spread reaches beyond the first column and row, too.
      const int border = view.is_translation ? 0 : 1;
      const auto project = [&](int y) {
        kernels::ProjectedValues row(width + border);
        if (y >= 0 && y < height) {
          kernels::ProjectedRow inside = row.row();
          inside.disparity_px += border;
          inside.nearness += border;
          inside.column += border;
          inside.line += border;
          kernels::project_row(view, {map.row(y), width, 0, y}, inside);
        }
        return row;
      };
      for (int y = -border; y < height; ++y) {
        kernels::ProjectedValues upper = project(y);
        kernels::ProjectedValues lower = project(y + 1);
        kernels::splat_rows({.view = view,
                             .upper = upper.row(),
                             .lower = lower.row(),
                             .count = width + border,
                             .first_column = -border,
                             .line = y,
                             .right_edge = kernels::right_edge_direction(view, (width - 1) / 2.0,
                                                                         (height - 1) / 2.0),
                             .lower_edge = kernels::lower_edge_direction(view, (width - 1) / 2.0,
                                                                         (height - 1) / 2.0),
                             .gradient_limit_px = 1},
                            {.nearness = expected.row(0),
                             .stride = static_cast<std::ptrdiff_t>(expected.view().stride()),
                             .width = view_width,
                             .first_line = 0,
                             .lines = view_height});
      }
      Image<float> nearness(view_width, view_height);
      map_surfaces(map.view(), view, 1, nearness.view(), execution);
      for (int y = 0; y < view_height; ++y) {
        ASSERT_EQ(std::vector<float>(nearness.row(y), nearness.row(y) + view_width),
                  std::vector<float>(expected.row(y), expected.row(y) + view_width))
            << width << "×" << height << ", line " << y << ", homography " << view.homography[0];
      }
    }
  }
}

TEST(SurfaceWarper, BaselineViewsAreThoseAlongScanlines) {
  std::mt19937 random(2);
  const Pair pair = random_pair<std::uint8_t>(random, 61, 23, 3);
  for (const double view_x : {-0.6, 0.0, 0.37, 1.0, 1.8}) {
    for (const WarpColour warp : {WarpColour::kOnePass, WarpColour::kForward}) {
      SynthesizedView expected;
      SynthesizedView view;
      pair.synthesize({.warp = warp}, view_x, execution(), expected);
      pair.synthesize({.warp = warp}, baseline_view(view_x, 0, 61, 23), execution(), view);
      EXPECT_EQ(bytes_of(view), bytes_of(expected));
    }
  }
}

// What a view on the baseline is if it goes the general way: the same, to the last bit.
TEST(SurfaceWarper, OnTheBaselineItEqualsTheScanlineWarp) {
  std::mt19937 random(3);
  // Without what looks at a view once it is warped and blended.
  const SynthesisOptions warp_alone{.holes = HoleFilling::kNone, .soft_edges = false};
  for (const int channels : {1, 3, 4}) {
    const Pair pair = random_pair<std::uint8_t>(random, 131, 37, channels);
    SynthesizedView expected;
    SynthesizedView view;
    pair.synthesize(warp_alone, 0.43, execution(), expected);
    // One line more than the images have: not a view that goes along scanlines.
    pair.synthesize(warp_alone, baseline_view(0.43, 0, 131, 38), execution(), view);
    const auto& image = std::get<Image<std::uint8_t>>(view.image.pixels);
    const auto& scanlines = std::get<Image<std::uint8_t>>(expected.image.pixels);
    ASSERT_EQ(image.height(), 38);
    EXPECT_EQ(std::memcmp(view.intensity.data(), expected.intensity.data(), sizeof(view.intensity)),
              0);
    for (int y = 0; y < 37; ++y) {
      ASSERT_EQ(std::vector<int>(image.row(y), image.row(y) + 131 * channels),
                std::vector<int>(scanlines.row(y), scanlines.row(y) + 131 * channels))
          << "row " << y;
      ASSERT_TRUE(std::equal(view.holes.row(y), view.holes.row(y) + 131, expected.holes.row(y)));
    }
  }
}

TEST(SurfaceWarper, IdenticalForAnyExecutionAndInstructionSet) {
  std::mt19937 random(4);
  const Pair pair = random_pair<std::uint8_t>(random, 151, 140, 3);
  for (const NewView& new_view : views_of(151, 140)) {
    expect_equal_for_every_execution([&](Execution& execution) {
      SynthesizedView view;
      pair.synthesize({}, new_view, execution, view);
      EXPECT_LT(view.hole_fraction, 0.9);
      return bytes_of(view);
    });
  }
}

// A textured plane, seen from anywhere: the homography of the plane says what a pixel shows.
TEST(SurfaceWarper, APlaneMovesByItsHomography) {
  const int width = 260;
  const int height = 200;
  const double slope_x = 0.021;
  const double slope_y = -0.034;
  const double offset = 14;
  const auto texture = [](double x, double y) {
    return 128 + 60 * std::sin(0.21 * x + 0.05 * y) + 50 * std::cos(0.17 * y - 0.08 * x);
  };
  const auto picture = [&](bool is_right, DisparityMap& map) {
    Image<float> image(width, height, 1);
    for (const auto [x, y] : positions_of(width, height)) {
      // d = slope_x · x + slope_y · y + offset of the left image's x, which is x + d in the
      // right.
      const double left_x = is_right ? (x + slope_y * y + offset) / (1 - slope_x) : x;
      map.at(x, y) = static_cast<float>(slope_x * left_x + slope_y * y + offset);
      image.at(x, y) = static_cast<float>(texture(left_x, y) / 255);
    }
    return Photograph{std::move(image)};
  };
  DisparityMap left_map(width, height);
  DisparityMap right_map(width, height);
  Photograph left = picture(false, left_map);
  Photograph right = picture(true, right_map);
  const Pair pair{std::move(left), std::move(right), std::move(left_map), std::move(right_map)};
  const RectifiedPair cameras = ideal_pair(width, height, 300);
  const Eigen::RowVector3d plane(slope_x, slope_y, offset);
  for (const NewView& new_view :
       {baseline_view(0.4, 0.7, width, height),
        camera_view(cameras, turned_camera(cameras, {0.5, 0.4, 0}, 0.3, 0.02, 0.03, 1)),
        camera_view(cameras, turned_camera(cameras, {-0.3, 0.2, 1.5}, -1.9, 0.05, -0.04, 1.3)),
        camera_view(cameras, turned_camera(cameras, {0.7, -0.2, -1}, 0, -0.1, 0.1, 2.7))}) {
    SynthesizedView view;
    pair.synthesize({}, new_view, execution(), view);
    const auto& image = std::get<Image<float>>(view.image.pixels);
    const Eigen::Matrix3d back =
        (new_view.from_left.homography + new_view.from_left.parallax * plane).inverse();
    double squares = 0;
    int count = 0;
    for (const auto [u, v] : positions_of(width, height)) {
      const Eigen::Vector3d seen = back * Eigen::Vector3d(u, v, 1);
      const double x = seen.x() / seen.z();
      const double y = seen.y() / seen.z();
      if (seen.z() <= 0 || x < 3 || y < 3 || x > width - 4 || y > height - 4) {
        continue;
      }
      ASSERT_EQ(view.holes.at(u, v), 0) << u << ", " << v;
      const double error = 255.0 * static_cast<double>(image.at(u, v)) - texture(x, y);
      squares += error * error;
      ++count;
    }
    EXPECT_GT(count, 8000);
    EXPECT_GT(10 * std::log10(255.0 * 255.0 * count / squares), 50) << "of " << count;
  }
}

/// A scene that is known exactly: its pictures and maps, and any view rendered from it.
class ExactScene {
 public:
  ExactScene(int width, int height)
      : scene_({.width_px = width, .height_px = height, .samples_per_side = 2}, execution_),
        cameras_(ideal_pair(width, height, scene_.focal_length_px())) {
    SceneRendering left = scene_.render({0, 0}, 0);
    SceneRendering right = scene_.render({1, 0}, 0);
    pair_ = {std::move(left.image), std::move(right.image), std::move(left.disparity),
             std::move(right.disparity)};
  }

  [[nodiscard]] const RectifiedPair& cameras() const { return cameras_; }
  [[nodiscard]] const Pair& pair() const { return pair_; }
  [[nodiscard]] Execution& execution() { return execution_; }

  [[nodiscard]] double psnr_off_the_baseline(double x, double y) {
    return psnr(scene_.camera({x, y}), baseline_view(x, y, cameras_.width_px, cameras_.height_px));
  }
  [[nodiscard]] double psnr_of(const PosedCamera& camera) {
    return psnr(camera, camera_view(cameras_, camera));
  }

 private:
  /// Of what either camera of the pair sees.
  double psnr(const PosedCamera& camera, const NewView& new_view) {
    const SceneRendering truth = scene_.render(camera, 0);
    const Mask not_left = scene_.occlusion(camera, scene_.camera({0, 0}), 0);
    const Mask not_right = scene_.occlusion(camera, scene_.camera({1, 0}), 0);
    Mask visible(new_view.width_px, new_view.height_px);
    for (const auto [x, y] : positions_of(new_view.width_px, new_view.height_px)) {
      const bool seen = not_left.at(x, y) == 0 || not_right.at(x, y) == 0;
      visible.at(x, y) = seen && std::isfinite(truth.disparity.at(x, y)) ? 255 : 0;
    }
    SynthesizedView view;
    pair_.synthesize({}, new_view, execution_, view);
    const ViewScores scores =
        evaluate_view(view.image, truth.image, execution_,
                      ImageView<const std::uint8_t>(std::as_const(visible).view()));
    EXPECT_GE(scores.pixels, new_view.width_px * new_view.height_px / 5);
    return scores.psnr_db;
  }

  Execution execution_{{.threads = 2}};
  LayeredScene scene_;
  RectifiedPair cameras_;
  Pair pair_;
};

// From exact maps to the picture rendered there, off the baseline and by cameras that are turned,
// rolled, nearer, farther, and of another focal length and size. Every 20th pixel is at an outline.
ExactScene& small_scene() {
  static ExactScene scene(320, 240);
  return scene;
}

TEST(SurfaceWarper, ExactMapsGiveTheRenderedView) {
  ExactScene& scene = small_scene();
  EXPECT_GE(scene.psnr_off_the_baseline(0.5, 0.3), 38.9);
  EXPECT_GE(scene.psnr_off_the_baseline(0.25, -0.5), 38.2);
  EXPECT_GE(scene.psnr_off_the_baseline(-0.3, 0.2), 38.5);
  const auto psnr = [&](const Eigen::Vector3d& centre, double roll, double yaw, double pitch,
                        double zoom = 1) {
    return scene.psnr_of(turned_camera(scene.cameras(), centre, roll, yaw, pitch, zoom));
  };
  EXPECT_GE(psnr({0.5, 0, 0}, 0, 0.1, 0.05), 38.7);
  EXPECT_GE(psnr({0.5, 0.2, 0}, 0.5, 0, 0), 38.3);
  EXPECT_GE(psnr({0.5, 0.2, 0}, 1.5707963267948966, 0, 0), 38);
  EXPECT_GE(psnr({0.5, 0.1, 1.5}, 0, 0, 0), 38.9);
  EXPECT_GE(psnr({0.5, 0.1, -1.5}, 0, 0, 0), 38.7);
  // Magnified and reduced.
  EXPECT_GE(psnr({0.5, 0, 0}, 0, 0, 0, 2), 35.7);
  EXPECT_GE(psnr({0.25, -0.3, 0}, 0.2, 0.1, 0, 3), 34.0);
  EXPECT_GE(psnr({0.5, 0, 0}, 0, 0, 0, 0.5), 41.0);
}

TEST(SurfaceWarper, ExactLargerMapsGiveTheRenderedView) {
  ExactScene scene(640, 480);
  PosedCamera turned = turned_camera(scene.cameras(), {0.4, 0.2, 0.5}, 0.1, 0.05, -0.04, 0.9);
  turned.width_px = 600;
  turned.matrix(0, 2) -= 30;
  EXPECT_GE(scene.psnr_of(turned), 41.2);
}

// As a view comes close to a camera, it becomes that camera's photograph, outlines included.
TEST(SurfaceWarper, BesideACameraOutlinesAreThePhotographs) {
  ExactScene& scene = small_scene();
  SynthesizedView view;
  scene.pair().synthesize({.match_intensities = false}, baseline_view(1e-4, 1e-4, 320, 240),
                          scene.execution(), view);
  EXPECT_GE(evaluate_view(view.image, scene.pair().left, scene.execution()).psnr_db, 50);
}

TEST(SurfaceWarper, SumsGiveTheFitOfTheView) {
  std::mt19937 random(5);
  const Pair pair = random_pair<std::uint16_t>(random, 90, 70, 3);
  const ViewSynthesizer synthesizer({}, execution());
  for (const NewView& new_view : views_of(90, 70)) {
    const auto sums = synthesizer.intensity_sums(
        {pair.left, pair.right, pair.left_disparity.view(), pair.right_disparity.view()}, new_view);
    EXPECT_GT(sums.pixels, 100);
    SynthesizedView view;
    pair.synthesize({}, new_view, execution(), view);
    const std::array<IntensityFit, 4> fit = fit_channels(sums, 3, 1);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(view.intensity[c].offset, fit[c].offset, 1e-6);
      EXPECT_NEAR(view.intensity[c].gain, fit[c].gain, 1e-9);
    }
    // A given fit warps once; the picture is the same.
    SynthesizedView given;
    pair.synthesize({}, new_view, execution(), given, &view.intensity);
    EXPECT_EQ(bytes_of(given), bytes_of(view));
  }
}

TEST(SurfaceWarper, HasTheViewsSizeAndReusesItsMemory) {
  std::mt19937 random(6);
  const Pair pair = random_pair<float>(random, 70, 50, 4);
  Execution execution({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  const RectifiedPair cameras = ideal_pair(70, 50, 90);
  PosedCamera camera = turned_camera(cameras, {0.5, 0.2, 0}, 0.1, 0, 0, 1);
  camera.width_px = 33;
  camera.height_px = 111;
  const NewView new_view = camera_view(cameras, camera);
  SynthesizedView view;
  pair.synthesize({}, new_view, execution, view);
  EXPECT_EQ(view.image.width(), 33);
  EXPECT_EQ(view.image.height(), 111);
  EXPECT_EQ(view.holes.width(), 33);
  EXPECT_GT(view.hole_fraction, 0.1);  // the view is taller than what the images show
  EXPECT_LT(view.hole_fraction, 0.9);
  const std::size_t held = execution.scratch().bytes_held();
  EXPECT_LT(held, ViewSynthesizer::working_bytes(new_view, 70, 50, 4) + 64 * 1024);
  pair.synthesize({}, new_view, execution, view);
  EXPECT_EQ(execution.scratch().bytes_held(), held);
}

TEST(SurfaceWarper, NothingIsKnown) {
  std::mt19937 random(7);
  Pair pair = random_pair<std::uint8_t>(random, 20, 10, 1);
  pair.left_disparity.fill(kUnknown);
  pair.right_disparity.fill(-std::numeric_limits<float>::infinity());
  for (const NewView& new_view : views_of(20, 10)) {
    SynthesizedView view;
    pair.synthesize({}, new_view, execution(), view);
    EXPECT_EQ(view.hole_fraction, 1);
  }
}

TEST(SurfaceWarper, WildDisparitiesDoNoHarm) {
  std::mt19937 random(8);
  Pair pair = random_pair<std::uint8_t>(random, 40, 30, 3);
  for (DisparityMap* map : {&pair.left_disparity, &pair.right_disparity}) {
    for (const float wild : {3e38F, -3e38F, 1e10F, -1e6F, 4000.0F}) {
      map->at(static_cast<int>(random() % 40), static_cast<int>(random() % 30)) = wild;
    }
  }
  for (const NewView& new_view : views_of(40, 30)) {
    SynthesizedView view;
    for (const double limit : {0.0, 1.0, 1e6}) {
      pair.synthesize({.disparity_gradient_limit_px = limit}, new_view, execution(), view);
      EXPECT_LT(view.hole_fraction, 1);
    }
  }
}

// Every colour of a forward warp is one that its image has.
TEST(SurfaceWarper, ForwardMovesWholePixels) {
  Image<std::uint8_t> numbered(16, 15, 1);
  Image<std::uint8_t> right(16, 15, 1);
  Image<float> disparity(16, 15);
  disparity.fill(4);
  for (const auto [x, y] : positions_of(16, 15)) {
    numbered.at(x, y) = static_cast<std::uint8_t>(y * 16 + x);
    right.at(x, y) = static_cast<std::uint8_t>(y * 16 + (x + 4) % 16);
  }
  SynthesizedView view;
  ViewSynthesizer({.warp = WarpColour::kForward,
                   .holes = HoleFilling::kNone,
                   .match_intensities = false,
                   .soft_edges = false},
                  execution())
      .synthesize({{numbered.copy()}, {right.copy()}, disparity.view(), disparity.view()},
                  baseline_view(0, 0.4, 16, 15), view);
  // 4 · 0.4 = 1.6 rows up, so the pixel two rows below lands here.
  const auto& image = std::get<Image<std::uint8_t>>(view.image.pixels);
  for (const auto [x, y] : positions_of(16, 13)) {
    EXPECT_EQ(image.at(x, y), (y + 2) * 16 + x);
  }
}

TEST(SurfaceWarper, RefusesWhatItCannotMake) {
  std::mt19937 random(9);
  const Pair pair = random_pair<std::uint8_t>(random, 20, 10, 3);
  SynthesizedView view;
  for (const auto& [width, height] : {std::pair{0, 10}, {20, 0}, {65501, 10}, {20, 65501}}) {
    EXPECT_THROW(pair.synthesize({}, baseline_view(0.5, 0.1, width, height), execution(), view),
                 Error);
  }
  NewView flat = baseline_view(0.5, 0.1, 20, 10);
  flat.from_right.homography.setOnes();
  EXPECT_THROW(pair.synthesize({}, flat, execution(), view), Error);
  flat.from_right.homography = Eigen::Matrix3d::Identity() * 2;
  flat.from_right.homography(0, 1) = std::nan("");
  EXPECT_THROW(pair.synthesize({}, flat, execution(), view), Error);
}

}  // namespace vantage::surface_warper_test
