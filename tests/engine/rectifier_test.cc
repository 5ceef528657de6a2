#include "engine/rectification/rectifier.h"

#include <Eigen/Dense>

#include "engine/generation/layered_scene.h"
#include "engine/image/left_out.h"
#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/every_execution.h"
#include "tests/keys_kernel.h"
#include "tests/test_paths.h"

namespace vantage::rectifier_test {

/// Bicubic interpolation in double; 0 outside of the image.
template <typename T>
double sample(const Image<T>& image, const Eigen::Vector2d& position, int channel) {
  const double x = position.x();
  const double y = position.y();
  if (!(x >= -0.5 && x <= image.width() - 0.5 && y >= -0.5 && y <= image.height() - 0.5)) {
    return 0;
  }
  double sum = 0;
  for (int j = static_cast<int>(std::floor(y)) - 1; j <= std::floor(y) + 2; ++j) {
    for (int i = static_cast<int>(std::floor(x)) - 1; i <= std::floor(x) + 2; ++i) {
      sum += keys(x - i) * keys(y - j) *
             static_cast<double>(image.at(std::clamp(i, 0, image.width() - 1),
                                          std::clamp(j, 0, image.height() - 1), channel));
    }
  }
  return sum;
}

const Camera& source_camera(const StereoCalibration& rig, Side side) {
  return side == Side::kLeft ? rig.left : rig.right;
}

template <typename T>
class RectifiedImages : public testing::Test {};
TYPED_TEST_SUITE(RectifiedImages, PixelTypes);

TYPED_TEST(RectifiedImages, AreThePhotographSeenThroughTheModel) {
  using T = TypeParam;
  std::mt19937 random(1);
  int black = 0;
  for (const auto& [width, height, radians] :
       {std::tuple{1, 1, 1e-5}, {1, 7, 1e-5}, {9, 1, 1e-5}, {13, 11, 0.01}, {43, 29, 0.05}}) {
    for (const int channels : {1, 3, 4}) {
      const int coefficients = channels == 1 ? 14 : channels == 3 ? 5 : 8;
      StereoCalibration rig = random_calibration(random, width, height, coefficients, radians);
      rig.translation.tail<2>() *= radians;
      for (Camera* camera : {&rig.left, &rig.right}) {
        camera->matrix(0, 2) = 0.49 * (width - 1);
        camera->matrix(1, 2) = 0.5 * (height - 1);
      }
      const double kept = channels == 4 ? 1 : 0;
      const Rectifier rectifier(rig, width, height, {.kept_outline = kept});
      EXPECT_TRUE(rectifier.needs_rectification());
      for (const Side side : {Side::kLeft, Side::kRight}) {
        const Photograph source = noise<T>(width, height, channels, 7);
        Photograph result;
        rectifier.apply(source, side, result, execution());
        blacken_left_out(result);
        ASSERT_EQ(result.width(), width);
        ASSERT_EQ(result.height(), height);
        ASSERT_EQ(result.channels(), channels);
        const auto& from = std::get<Image<T>>(source.pixels);
        const auto& to = std::get<Image<T>>(result.pixels);
        const RectifiedCamera& camera = rectifier.pair().camera(side);
        for (const auto [x, y] : positions_of(width, height)) {
          const Eigen::Vector3d ray =
              (camera.matrix * camera.rotation).inverse() * Eigen::Vector3d(x, y, 1);
          const Eigen::Vector2d position =
              plain_projection(source_camera(rig, side), ray.x() / ray.z(), ray.y() / ray.z());
          const auto said = rectifier.source_position(side, {x, y});
          ASSERT_TRUE(said);
          ASSERT_LT((*said - position).norm(), 1e-8);
          // On the very edge rounding decides.
          const auto from_edge = [](double at, int size) {
            return std::min(std::abs(at + 0.5), std::abs(at - (size - 0.5)));
          };
          if (std::min(from_edge(position.x(), width), from_edge(position.y(), height)) < 1e-4) {
            continue;
          }
          black += sample(from, position, 0) == 0 ? 1 : 0;
          for (int c = 0; c < channels; ++c) {
            constexpr bool kIsFloat = std::is_same_v<T, float>;
            const double largest = kIsFloat ? 1 : std::numeric_limits<T>::max();
            const double value = sample(from, position, c);
            ASSERT_NEAR(to.at(x, y, c), std::clamp(value, 0.0, largest),
                        kIsFloat ? 1e-4 : 0.5 + largest * 1e-4)
                << width << "x" << height << "x" << channels << " at " << x << ", " << y;
          }
        }
      }
    }
  }
  EXPECT_GT(black, 20);
}

TEST(Rectifier, SameBitsForEveryExecutor) {
  std::mt19937 random(2);
  const Rectifier rectifier(random_calibration(random, 131, 77, 5), 131, 77);
  const Photograph source = noise<std::uint8_t>(131, 77, 3);
  expect_equal_for_every_execution([&](Execution& execution) {
    Photograph result;
    rectifier.apply(source, Side::kRight, result, execution);
    return values_of(result);
  });
}

TEST(Rectifier, KeepsTheMemoryOfItsResult) {
  std::mt19937 random(3);
  const Rectifier rectifier(random_calibration(random, 64, 48, 5), 64, 48);
  Photograph result = noise<float>(10, 10, 1);
  rectifier.apply(noise<std::uint8_t>(64, 48, 3), Side::kLeft, result, execution());
  const auto* memory = std::get<Image<std::uint8_t>>(result.pixels).row(0);
  rectifier.apply(noise<std::uint8_t>(64, 48, 3, 2), Side::kRight, result, execution());
  EXPECT_EQ(std::get<Image<std::uint8_t>>(result.pixels).row(0), memory);
}

TEST(Rectifier, AlphaIsOpaqueInsideAndNothingOutside) {
  std::mt19937 random(4);
  StereoCalibration rig = random_calibration(random, 120, 90, 5);
  const Rectifier rectifier(rig, 120, 90, {.kept_outline = 1});
  Photograph source = noise<std::uint8_t>(120, 90, 4);
  auto& pixels = std::get<Image<std::uint8_t>>(source.pixels);
  for (const auto [x, y] : positions_of(120, 90)) {
    pixels.at(x, y, 3) = 255;
  }
  Photograph result;
  rectifier.apply(source, Side::kLeft, result, execution());
  blacken_left_out(result);
  const auto& image = std::get<Image<std::uint8_t>>(result.pixels);
  const PixelRectangle& valid = rectifier.pair().valid;
  int outside = 0;
  for (const auto [x, y] : positions_of(120, 90)) {
    const std::uint8_t* pixel = image.row(y) + 4 * x;
    ASSERT_TRUE(pixel[3] == 255 || (pixel[0] | pixel[1] | pixel[2] | pixel[3]) == 0);
    const bool is_valid =
        x >= valid.x && x < valid.x + valid.width && y >= valid.y && y < valid.y + valid.height;
    ASSERT_TRUE(!is_valid || pixel[3] == 255) << x << ", " << y;
    outside += pixel[3] == 0 ? 1 : 0;
  }
  EXPECT_GT(outside, 10);
}

TEST(Rectifier, PositionsGoThereAndBack) {
  std::mt19937 random(5);
  const Rectifier rectifier(random_calibration(random, 640, 480, 8), 640, 480);
  for (const Side side : {Side::kLeft, Side::kRight}) {
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d rectified(uniform(random, 0, 639), uniform(random, 0, 479));
      const auto source = rectifier.source_position(side, rectified);
      ASSERT_TRUE(source);
      const auto again = rectifier.rectified_position(side, *source);
      ASSERT_TRUE(again);
      EXPECT_LT((*again - rectified).norm(), 1e-6);
    }
  }
}

TEST(Rectifier, LeavesRectifiedImagesAlone) {
  StereoCalibration rig;
  rig.left.matrix << 50, 0, 20, 0, 50, 10, 0, 0, 1;
  rig.right = rig.left;
  rig.is_rectified = true;
  const Rectifier rectifier(rig, 40, 21);
  EXPECT_FALSE(rectifier.needs_rectification());
  const Photograph source = noise<std::uint16_t>(40, 21, 3);
  Photograph result;
  rectifier.apply(source, Side::kLeft, result, execution());
  EXPECT_TRUE(same(source, result));
  EXPECT_EQ(*rectifier.source_position(Side::kRight, {3, 4}), Eigen::Vector2d(3, 4));
  EXPECT_EQ(*rectifier.rectified_position(Side::kRight, {3, 4}), Eigen::Vector2d(3, 4));
  EXPECT_EQ(
      error_of([&] { rectifier.apply(noise<float>(41, 21, 1), Side::kLeft, result, execution()); }),
      "the image to rectify is 41x21, expected 40x21");
}

/// How far `image` is shifted against `expected` in a block: least squares on the gradient.
Eigen::Vector2d shift_px(const Image<std::uint8_t>& image, const Image<float>& expected, int x0,
                         int y0, int size) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const auto [x, y] : positions_of({x0, x0 + size}, {y0, y0 + size})) {
    const Eigen::Vector2d gradient((expected.at(x + 1, y) - expected.at(x - 1, y)) / 2,
                                   (expected.at(x, y + 1) - expected.at(x, y - 1)) / 2);
    normal += gradient * gradient.transpose();
    right -= gradient * (static_cast<double>(image.at(x, y, 1)) - expected.at(x, y));
  }
  return normal.inverse() * right;
}

// A scene with exact geometry, photographed by cameras that are turned and distort, rectified, and
// compared with what the rectified cameras ought to show.
TEST(Rectifier, BringsBackRowsOfADistortedScene) {
  const int width = 300;
  const int height = 220;
  LayeredScene scene({.width_px = 460, .height_px = 340, .samples_per_side = 2}, execution());
  const double focal = scene.focal_length_px();
  const auto turn = [](double x, double y, double z) {
    return Eigen::Matrix3d((Eigen::AngleAxisd(x, Eigen::Vector3d::UnitX()) *
                            Eigen::AngleAxisd(y, Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(z, Eigen::Vector3d::UnitZ()))
                               .toRotationMatrix());
  };
  const Eigen::Matrix3d turned[2] = {turn(0.02, 0.015, -0.03), turn(-0.015, -0.02, 0.02)};
  StereoCalibration rig;
  rig.left.matrix << 0.8 * focal, 0, 152, 0, 0.81 * focal, 108, 0, 0, 1;
  rig.right.matrix << 0.82 * focal, 0, 147, 0, 0.8 * focal, 112, 0, 0, 1;
  rig.left.distortion = {-0.25, 0.08, 1e-3, -2e-3, 0.01};
  rig.right.distortion = {0.15, -0.05, -1e-3, 1e-3, 0.02};
  rig.rotation = turned[1] * turned[0].transpose();
  rig.translation = -turned[1] * Eigen::Vector3d::UnitX();
  const Rectifier rectifier(rig, width, height);

  double sum_squares = 0;
  int blocks = 0;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const int index = static_cast<int>(index_of(side));
    const SceneRendering rendering = scene.render({static_cast<double>(index), 0}, 0);
    const auto& seen = std::get<Image<std::uint8_t>>(rendering.image.pixels);
    // Where a ray of the scene's own frame lies in its rendering.
    const auto in_rendering = [&](const Eigen::Vector3d& ray) {
      return Eigen::Vector2d(focal * ray.x() / ray.z() + (seen.width() - 1) / 2.0,
                             focal * ray.y() / ray.z() + (seen.height() - 1) / 2.0);
    };
    const LensModel lens(source_camera(rig, side));
    Image<std::uint8_t> photograph(width, height, 3);
    for (const auto [x, y] : positions_of(width, height)) {
      const auto ray = lens.ray_of({x, y});
      ASSERT_TRUE(ray);
      const Eigen::Vector2d at = in_rendering(turned[index].transpose() * ray->homogeneous());
      for (int c = 0; c < 3; ++c) {
        photograph.at(x, y, c) =
            static_cast<std::uint8_t>(std::lround(std::clamp(sample(seen, at, c), 0.0, 255.0)));
      }
    }
    Photograph result;
    rectifier.apply(Photograph{std::move(photograph)}, side, result, execution());
    // One frame for both: where the left camera was turned to.
    const Eigen::Matrix3d to_scene = (rectifier.pair().left.rotation * turned[0]).transpose() *
                                     rectifier.pair().camera(side).matrix.inverse();
    Image<float> expected(width, height);
    for (const auto [x, y] : positions_of(width, height)) {
      const Eigen::Vector3d ray = to_scene * Eigen::Vector3d(x, y, 1);
      expected.at(x, y) = static_cast<float>(sample(seen, in_rendering(ray), 1));
    }
    const int size = 36;
    for (int y = 1; y + size < height; y += size) {
      for (int x = 1; x + size < width; x += size) {
        const Eigen::Vector2d shift =
            shift_px(std::get<Image<std::uint8_t>>(result.pixels), expected, x, y, size);
        EXPECT_LT(std::abs(shift.y()), 0.08) << "at " << x << ", " << y;
        EXPECT_LT(std::abs(shift.x()), 0.08) << "at " << x << ", " << y;
        sum_squares += shift.squaredNorm();
        ++blocks;
      }
    }
  }
  EXPECT_LT(std::sqrt(sum_squares / blocks), 0.02);
}

TEST(Rectifier, ChessboardCornersMeetInOneRow) {
  const std::filesystem::path folder = test_paths::shared_data() / "chessboard";
  if (!std::filesystem::exists(folder / "corners.txt")) {
    GTEST_SKIP() << "no chessboard photographs at " << folder;
  }
  const Rectifier rectifier(read_stereo_calibration(folder / "stereo_reference.yml"), 640, 480);
  std::ifstream file(folder / "corners.txt");
  double sum_squares = 0;
  double raw_sum_squares = 0;
  int corners = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream values(line);
    std::string image;
    double number, board_x, board_y, left_x, left_y, right_x, right_y;
    if (!(values >> image >> number >> board_x >> board_y >> left_x >> left_y >> right_x >>
          right_y)) {
      continue;
    }
    const auto left = rectifier.rectified_position(Side::kLeft, {left_x, left_y});
    const auto right = rectifier.rectified_position(Side::kRight, {right_x, right_y});
    ASSERT_TRUE(left && right);
    sum_squares += std::pow(left->y() - right->y(), 2);
    raw_sum_squares += std::pow(left_y - right_y, 2);
    EXPECT_GT(left->x(), right->x());
    ++corners;
  }
  EXPECT_EQ(corners, 13 * 54);
  EXPECT_NEAR(std::sqrt(sum_squares / corners), 0.26, 0.03);
  EXPECT_GT(std::sqrt(raw_sum_squares / corners), 5);
}

}  // namespace vantage::rectifier_test
