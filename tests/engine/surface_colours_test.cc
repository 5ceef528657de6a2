#include "engine/synthesis/image_warper.h"

#include <Eigen/Dense>

#include "engine/synthesis/photograph_grid.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/posed_camera.h"
#include "kernels/photograph_position/photograph_position.h"
#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/every_execution.h"

namespace vantage::surface_colours_test {

constexpr int kWidth = 240;
constexpr int kHeight = 180;

Eigen::Matrix3d turn(double x, double y, double z) {
  return (Eigen::AngleAxisd(x, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(y, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(z, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// Cameras that are turned and distort.
StereoCalibration distorting_rig() {
  StereoCalibration rig;
  rig.left.matrix << 210, 0, 121, 0, 212, 88, 0, 0, 1;
  rig.right.matrix << 214, 0, 118, 0, 211, 91, 0, 0, 1;
  rig.left.distortion = {-0.25, 0.08, 1e-3, -2e-3, 0.01};
  rig.right.distortion = {0.15, -0.05, -1e-3, 1e-3, 0.02};
  const Eigen::Matrix3d left = turn(0.02, 0.015, -0.04);
  const Eigen::Matrix3d right = turn(-0.015, -0.02, 0.03);
  rig.rotation = right * left.transpose();
  rig.translation = -right * Eigen::Vector3d::UnitX();
  return rig;
}

/// A slanted wall and a plate in front of it, both with a texture of sine waves: what any ray sees
/// is a formula. Lengths in baselines, in the frame of the rectified left camera.
class Wall {
 public:
  explicit Wall(const RectifiedPair& pair) : focal_px_(pair.left.matrix(0, 0)) {}

  struct Seen {
    double depth;
    double colour;  ///< 0..1
  };

  [[nodiscard]] Seen look(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const {
    const double to_plate = (kPlateDepth - from.z()) / along.z();
    const Eigen::Vector3d plate = from + to_plate * along;
    if (std::abs(plate.x() - 1) < 1.2 && std::abs(plate.y()) < 1) {
      return {kPlateDepth, texture(plate / kPlateDepth, 1.0)};
    }
    const double to_wall = (kWallDepth - kNormal.dot(from)) / kNormal.dot(along);
    const Eigen::Vector3d wall = from + to_wall * along;
    return {wall.z(), texture(wall / kWallDepth, 0.0)};
  }
  [[nodiscard]] double disparity_px(double depth) const { return focal_px_ / depth; }

 private:
  static constexpr double kPlateDepth = 10;
  static constexpr double kWallDepth = 18;
  inline static const Eigen::Vector3d kNormal{0.1, -0.15, 1};

  // At most 0.3 periods per pixel.
  [[nodiscard]] double texture(const Eigen::Vector3d& at, double phase) const {
    const double u = focal_px_ * at.x();
    const double v = focal_px_ * at.y();
    constexpr double kWaves[][2] = {
        {0.03, 0.02}, {-0.11, 0.07}, {0.2, 0.1}, {0.05, -0.28}, {0.29, 0.04}};
    double sum = 0.5;
    for (const auto& wave : kWaves) {
      sum += 0.09 * std::sin(2 * std::numbers::pi * (wave[0] * u + wave[1] * v) + phase);
      phase += 1;
    }
    return sum;
  }

  double focal_px_;
};

/// A rectified pair that photographs were made for.
struct Scene {
  Rectifier rectifier;
  PhotographGrid grid;
  std::array<Photograph, 2> photographs;
  std::array<Photograph, 2> rectified;
  DisparityMaps maps;
  std::array<Image<float>, 2> photograph_maps;

  explicit Scene(const StereoCalibration& rig, int width = kWidth, int height = kHeight,
                 Execution& on = execution(), double kept_outline = 0)
      : rectifier(rig, width, height, {.kept_outline = kept_outline}), grid(rectifier, on) {}

  UnrectifiedPair unrectified() {
    grid.bring(maps, photograph_maps);
    return grid.pair_of(photographs[0], photographs[1], photograph_maps);
  }
  /// Of the rectified images; with photographs, of those.
  [[nodiscard]] ViewSource source(const std::optional<UnrectifiedPair>& from = {}) const {
    return {rectified[0], rectified[1], maps.left.disparity_px.view(),
            maps.right.disparity_px.view(), from};
  }
  void rectify() {
    rectifier.apply(photographs[0], Side::kLeft, rectified[0], execution());
    rectifier.apply(photographs[1], Side::kRight, rectified[1], execution());
  }
  SynthesizedView from_photographs(const NewView& view, Execution& on = execution(),
                                   const SynthesisOptions& options = {}) {
    SynthesizedView result;
    ViewSynthesizer(options, on).synthesize(source(unrectified()), view, result);
    return result;
  }
  [[nodiscard]] SynthesizedView from_rectified(const NewView& view,
                                               const SynthesisOptions& options = {}) const {
    SynthesizedView result;
    ViewSynthesizer(options, execution()).synthesize(source(), view, result);
    return result;
  }
};

/// The wall with its exact maps.
struct WallScene : Scene {
  WallScene() : WallScene(distorting_rig()) {}

 private:
  explicit WallScene(const StereoCalibration& rig) : Scene(rig) {
    const RectifiedPair& pair = rectifier.pair();
    const Wall wall(pair);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const std::size_t index = index_of(side);
      const Eigen::Vector3d centre(static_cast<double>(index), 0, 0);
      const RectifiedCamera& camera = pair.camera(side);
      const LensModel lens(index == 0 ? rig.left : rig.right);
      Image<float> photograph(kWidth, kHeight);
      DisparityMap map(kWidth, kHeight);
      for (const auto [x, y] : positions_of(kWidth, kHeight)) {
        const Eigen::Vector3d seen = camera.rotation * lens.ray_of({x, y})->homogeneous();
        photograph.at(x, y) = static_cast<float>(wall.look(centre, seen).colour);
        const Eigen::Vector3d ray = camera.matrix.inverse() * Eigen::Vector3d(x, y, 1);
        map.at(x, y) = static_cast<float>(wall.disparity_px(wall.look(centre, ray).depth));
      }
      photographs[index].pixels = std::move(photograph);
      (index == 0 ? maps.left.disparity_px : maps.right.disparity_px) = std::move(map);
    }
    rectify();
  }
};

/// Noise and maps with jumps, for comparisons.
template <typename T>
struct NoiseScene : Scene {
  NoiseScene(int width, int height, int channels, Execution& on, double kept_outline = 0)
      : Scene(random_rig(width, height), width, height, on, kept_outline) {
    photographs = {noise<T>(width, height, channels, 1), noise<T>(width, height, channels, 2)};
    for (DisparityMap* map : {&maps.left.disparity_px, &maps.right.disparity_px}) {
      map->resize(width, height);
      for (const auto [x, y] : positions_of(width, height)) {
        map->at(x, y) = static_cast<float>((x / 9 + y / 7) % 3 * 4) + 0.3F;
      }
      map->at(width / 2, height / 2) = std::numeric_limits<float>::quiet_NaN();
    }
    rectify();
  }

 private:
  static StereoCalibration random_rig(int width, int height) {
    std::mt19937 random(7);
    return random_calibration(random, width, height, 5, 0.03);
  }
};

PosedCamera turned_camera(const RectifiedPair& pair) {
  PosedCamera camera;
  camera.matrix = pair.left.matrix;
  camera.rotation = turn(0.03, -0.02, 0.2);
  camera.translation = -camera.rotation * Eigen::Vector3d(0.4, 0.3, 0.5);
  camera.width_px = kWidth;
  camera.height_px = kHeight;
  return camera;
}

/// Of the pixels that both images of the pair see, away from outlines and the view's sides.
double psnr_db(const SynthesizedView& view, const Image<float>& truth, const Image<float>& depth) {
  constexpr int kMargin = 3;
  const auto& image = std::get<Image<float>>(view.image.pixels);
  double sum = 0;
  int count = 0;
  for (const auto [x, y] :
       positions_of({kMargin, kWidth - kMargin}, {kMargin, kHeight - kMargin})) {
    bool is_smooth = true;
    for (int j = -kMargin; j <= kMargin; ++j) {
      for (int i = -kMargin; i <= kMargin; ++i) {
        is_smooth = is_smooth && std::abs(depth.at(x + i, y + j) - depth.at(x, y)) < 1 &&
                    view.sources.at(x + i, y + j) == 255;
      }
    }
    if (is_smooth) {
      const double error = image.at(x, y) - truth.at(x, y);
      sum += error * error;
      ++count;
    }
  }
  EXPECT_GT(count, kWidth * kHeight / 3);
  return 10 * std::log10(count / sum);
}

// What one interpolation is for: a texture near the limit of what pixels can hold comes out nearer
// to what a camera there would see than after two.
TEST(SurfaceColours, OneInterpolationIsNearerToTheTruthThanTwo) {
  WallScene scene;
  const RectifiedPair& pair = scene.rectifier.pair();
  const Wall wall(pair);
  struct Case {
    std::string name;
    NewView view;
    Eigen::Vector3d centre;
    Eigen::Matrix3d ray_from_pixel;
    double min_gain_db;
  };
  const PosedCamera turned = turned_camera(pair);
  const Eigen::Matrix3d straight = pair.left.matrix.inverse();
  // On the baseline rows stay rows: there only columns are interpolated twice.
  const Case cases[] = {
      {"on the baseline", baseline_view(0.4, 0, kWidth, kHeight), {0.4, 0, 0}, straight, 1.3},
      {"below it", baseline_view(0.6, 0.7, kWidth, kHeight), {0.6, 0.7, 0}, straight, 2.5},
      {"turned", camera_view(pair, turned), turned.centre(),
       turned.rotation.transpose() * turned.matrix.inverse(), 2.5}};
  for (const Case& one : cases) {
    Image<float> truth(kWidth, kHeight);
    Image<float> depth(kWidth, kHeight);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      const Wall::Seen seen = wall.look(one.centre, one.ray_from_pixel * Eigen::Vector3d(x, y, 1));
      truth.at(x, y) = static_cast<float>(seen.colour);
      depth.at(x, y) = static_cast<float>(seen.depth);
    }
    const double once = psnr_db(scene.from_photographs(one.view), truth, depth);
    const double twice = psnr_db(scene.from_rectified(one.view), truth, depth);
    EXPECT_GT(once, twice + one.min_gain_db) << one.name;
    EXPECT_GT(once, 30) << one.name;
  }
}

// At a camera there is nothing to move, and the only interpolation left is the rectifier's own.
// Pixels at the sides of the rectified image have neighbours in the photograph that it does not
// show; they count all the same.
TEST(SurfaceColours, AtACameraTheViewIsTheRectifiedImage) {
  const auto expect_equal = [](Scene&& scene, int width, int height) {
    for (DisparityMap* map : {&scene.maps.left.disparity_px, &scene.maps.right.disparity_px}) {
      map->fill(2);
    }
    SynthesisOptions options;
    options.gamma.reset();
    for (const int camera : {0, 1}) {
      const NewView at_camera = baseline_view(camera, 0, width, height);
      const SynthesizedView view = scene.from_photographs(at_camera, execution(), options);
      std::visit(
          [&]<typename T>(const Image<T>& image) {
            const Photograph& rectified = scene.rectified[static_cast<std::size_t>(camera)];
            const auto& expected = std::get<Image<T>>(rectified.pixels);
            // Half a level of 8 bits; of those themselves, one.
            const double limit = std::max(0.51 / double{kGreyLevelsPerUnit<T>},
                                          std::is_same_v<T, std::uint8_t> ? 1.0 : 0.0);
            for (const auto [x, y] : positions_of(width * image.channels(), height)) {
              const bool is_seen =
                  rectified.left_out.empty() || rectified.left_out.at(x / image.channels(), y) == 0;
              const double value = is_seen ? static_cast<double>(expected.row(y)[x]) : 0;
              ASSERT_LE(std::abs(static_cast<double>(image.row(y)[x]) - value), limit)
                  << "camera " << camera << " at " << x << ", " << y;
            }
          },
          view.image.pixels);
    }
  };
  expect_equal(NoiseScene<std::uint8_t>(67, 41, 3, execution()), 67, 41);
  expect_equal(NoiseScene<std::uint16_t>(61, 37, 1, execution()), 61, 37);
  expect_equal(NoiseScene<float>(53, 64, 4, execution()), 53, 64);
  // Black where the photographs end.
  expect_equal(NoiseScene<std::uint8_t>(67, 41, 3, execution(), 1), 67, 41);
}

// Between the entries of its tables, too, a place lies where the rectifier has it.
TEST(SurfaceColours, AreFetchedAtTheRectifiersPositions) {
  constexpr double kPrecision = 1e-3;  // px; the grid is that of a small image, so lenses bend most
  std::mt19937 random(11);
  for (const int coefficients : {0, 5, 8, 14}) {
    const Rectifier rectifier(random_calibration(random, kWidth, kHeight, coefficients), kWidth,
                              kHeight);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const PhotographPositions table = rectifier.source_positions(side);
      const kernels::PhotographTable values{.x_px = table.x_px.data(),
                                            .y_px = table.y_px.data(),
                                            .stride = static_cast<int>(table.x_px.stride()),
                                            .width = kWidth,
                                            .height = kHeight,
                                            .photograph_width = kWidth,
                                            .photograph_height = kHeight};
      double largest = 0;
      for (int i = 0; i < 2000; ++i) {
        const Eigen::Vector2d place(uniform(random, 0, kWidth - 1),
                                    uniform(random, 0, kHeight - 1));
        auto column = static_cast<std::int32_t>(place.x());
        auto line = static_cast<std::int32_t>(place.y());
        auto fraction_x = static_cast<float>(place.x() - column);
        auto fraction_y = static_cast<float>(place.y() - line);
        float disparity = 1;
        kernels::photograph_positions_row(values,
                                          {.column = &column,
                                           .line = &line,
                                           .fraction_x = &fraction_x,
                                           .fraction_y = &fraction_y,
                                           .disparity_px = &disparity},
                                          1);
        const Eigen::Vector2d found(column + double{fraction_x}, line + double{fraction_y});
        ASSERT_EQ(disparity, 1);
        largest = std::max(largest, (found - *rectifier.source_position(side, place)).norm());
      }
      EXPECT_LT(largest, kPrecision) << coefficients << " coefficients";
    }
  }
}

// Nothing of the plate comes into the wall beside it, however the lens bends its outline.
TEST(SurfaceColours, DoNotMixAcrossOutlines) {
  WallScene scene;
  for (std::size_t k = 0; k < 2; ++k) {
    // Black wall, white plate, told apart by the disparity that the photograph's pixels have.
    auto& photograph = std::get<Image<float>>(scene.photographs[k].pixels);
    scene.grid.bring(k == 0 ? Side::kLeft : Side::kRight,
                     (k == 0 ? scene.maps.left.disparity_px : scene.maps.right.disparity_px).view(),
                     scene.photograph_maps[k]);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      photograph.at(x, y) = scene.photograph_maps[k].at(x, y) > 16 ? 1.0F : 0.0F;
    }
  }
  SynthesisOptions options;
  options.match_intensities = false;
  options.soft_edges = false;
  for (const NewView& position :
       {baseline_view(0.5, 0, kWidth, kHeight), baseline_view(0.3, 0.4, kWidth, kHeight)}) {
    const SynthesizedView view = scene.from_photographs(position, execution(), options);
    const auto& image = std::get<Image<float>>(view.image.pixels);
    int white = 0;
    int mixed = 0;
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      constexpr float kRounding = 1e-5F;
      const float grey = std::min(image.at(x, y), 1 - image.at(x, y));
      white += image.at(x, y) > 0.5F ? 1 : 0;
      mixed += grey > kRounding ? 1 : 0;
    }
    EXPECT_GT(white, 1000);
    EXPECT_EQ(mixed, 0);
  }
}

TEST(SurfaceColours, SameBitsForEveryExecutorAndInstructionSet) {
  const NewView turned = [] {
    std::mt19937 random(7);
    const Rectifier rectifier(random_calibration(random, 83, 59, 5, 0.03), 83, 59);
    PosedCamera camera = turned_camera(rectifier.pair());
    camera.translation *= rectifier.pair().baseline;
    return camera_view(rectifier.pair(), camera);
  }();
  for (const NewView& view :
       {baseline_view(0.37, 0, 83, 59), baseline_view(0.6, -0.4, 83, 59), turned}) {
    expect_equal_for_every_execution([&](Execution& execution) {
      return values_of(
          NoiseScene<std::uint8_t>(83, 59, 3, execution).from_photographs(view, execution).image);
    });
  }
}

TEST(SurfaceColours, OfAPairWithoutLensAreThoseOfTheRectifiedImages) {
  StereoCalibration rig;
  rig.left.matrix << 100, 0, 40, 0, 100, 29, 0, 0, 1;
  rig.right = rig.left;
  rig.translation = {-1, 0, 0};
  Scene scene(rig, 81, 59);
  ASSERT_TRUE(scene.rectifier.needs_rectification());
  NoiseScene<std::uint8_t> other(81, 59, 3, execution());
  scene.photographs = std::move(other.photographs);
  scene.maps = std::move(other.maps);
  scene.rectify();
  ASSERT_TRUE(same(scene.photographs[0], scene.rectified[0]));
  for (const NewView& view : {baseline_view(0.37, 0, 81, 59), baseline_view(0.6, -0.4, 81, 59)}) {
    const SynthesizedView once = scene.from_photographs(view);
    const SynthesizedView twice = scene.from_rectified(view);
    EXPECT_TRUE(same({once.holes.copy()}, {twice.holes.copy()}));
    const auto& a = std::get<Image<std::uint8_t>>(once.image.pixels);
    const auto& b = std::get<Image<std::uint8_t>>(twice.image.pixels);
    for (const auto [x, y] : positions_of(81 * 3, 59)) {
      ASSERT_NEAR(a.row(y)[x], b.row(y)[x], 1) << x << ", " << y;
    }
  }
}

TEST(SurfaceColours, RegressionSeesThePhotographs) {
  WallScene scene;
  auto& left = std::get<Image<float>>(scene.photographs[0].pixels);
  for (int y = 0; y < kHeight; ++y) {
    std::for_each(left.row(y), left.row(y) + kWidth,
                  [](float& value) { value = 0.1F + 0.5F * value; });
  }
  const ViewSynthesizer synthesizer({}, execution());
  const kernels::IntensitySums sums = synthesizer.intensity_sums(
      scene.source(scene.unrectified()), baseline_view(0.5, 0, kWidth, kHeight));
  const IntensityFit fit = fit_channels(sums, 1, 1)[0];
  EXPECT_NEAR(fit.gain, 2, 0.1);
  EXPECT_NEAR(fit.offset, -0.2 * 255, 0.1 * 255);
}

TEST(SurfaceColours, RefuseTheBooksWarpAndGeometryOfAnotherSize) {
  NoiseScene<std::uint8_t> scene(40, 30, 1, execution());
  SynthesisOptions forward;
  forward.warp = WarpColour::kForward;
  const NewView view = baseline_view(0.5, 0, 40, 30);
  EXPECT_THAT(error_of([&] { (void)scene.from_photographs(view, execution(), forward); }),
              HasSubstr("expected warp one-pass"));
  const Image<float> narrow(39, 30);
  UnrectifiedPair pair = scene.unrectified();
  pair.right_geometry.disparity_px = narrow.view();
  SynthesizedView result;
  EXPECT_THAT(error_of([&] {
                ViewSynthesizer({}, execution()).synthesize(scene.source(pair), view, result);
              }),
              HasSubstr("is 39×30, expected 40×30"));
}

}  // namespace vantage::surface_colours_test
