// Views from the place of a camera of the pair are its photograph, moved by a homography: known
// without any disparity, by resampling the photograph with OpenCV.

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/rectification/rectifier.h"
#include "engine/synthesis/photograph_grid.h"
#include "engine/synthesis/pose_renderer.h"
#include "engine/synthesis/three_step_synthesizer.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/unrectified_pair.h"

namespace vantage::view_at_camera_test {

constexpr int kWidth = 240;
constexpr int kHeight = 180;

/// Angles in degrees.
struct Turn {
  double roll = 0;
  double yaw = 0;
  double pitch = 0;
  double zoom = 1;

  [[nodiscard]] Eigen::Matrix3d rotation() const {
    constexpr double kDegree = std::numbers::pi / 180;
    return (Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
  }
  [[nodiscard]] std::string text() const {
    return "roll " + std::to_string(roll) + ", yaw " + std::to_string(yaw) + ", pitch " +
           std::to_string(pitch) + ", zoom " + std::to_string(zoom);
  }
};

/// A camera at `centre`, turned and zoomed from `matrix` and `rotation`.
PosedCamera posed(const Eigen::Matrix3d& matrix, const Eigen::Matrix3d& rotation,
                  const Eigen::Vector3d& centre, const Turn& turn) {
  PosedCamera camera;
  camera.matrix = matrix;
  camera.matrix.topLeftCorner<2, 2>() *= turn.zoom;
  camera.rotation = turn.rotation() * rotation;
  camera.translation = -camera.rotation * centre;
  camera.width_px = kWidth;
  camera.height_px = kHeight;
  return camera;
}

/// Pixels of a view that lie inside an image, two of its pixels from the border.
Mask inside(const Eigen::Matrix3d& homography) {
  const Eigen::Matrix3d back = homography.inverse();
  Mask mask(kWidth, kHeight);
  for (const auto [x, y] : positions_of(kWidth, kHeight)) {
    const Eigen::Vector3d at = back * Eigen::Vector3d(x, y, 1);
    const Eigen::Vector2d place = at.hnormalized();
    mask.at(x, y) = at.z() > 0 && place.x() >= 2 && place.y() >= 2 && place.x() <= kWidth - 3 &&
                            place.y() <= kHeight - 3
                        ? 255
                        : 0;
  }
  return mask;
}

double psnr(const Photograph& view, const Photograph& truth, const Mask& mask,
            Execution& execution) {
  return evaluate_view(view, truth, execution, ImageView<const std::uint8_t>(mask.view())).psnr_db;
}

const std::array<Turn, 9> kTurns = {{{.zoom = 0.5},
                                     {.zoom = 0.7},
                                     {.zoom = 2},
                                     {.zoom = 3},
                                     {.roll = 30},
                                     {.yaw = 30},
                                     {.pitch = -20, .zoom = 1.5},
                                     {.roll = -50, .yaw = 15, .zoom = 0.5},
                                     {.roll = 20, .yaw = -30, .zoom = 2.5}}};

class ViewAtCamera : public testing::Test {
 protected:
  Execution execution_{{.threads = 2}};
  LayeredScene scene_{{.width_px = kWidth, .height_px = kHeight, .samples_per_side = 2},
                      execution_};
};

TEST_F(ViewAtCamera, IsThePhotographResampledAndNoWorseThanThreeSteps) {
  const SceneRendering images[] = {scene_.render(SceneView{0, 0}, 0),
                                   scene_.render(SceneView{1, 0}, 0)};
  RectifiedPair pair;
  pair.width_px = kWidth;
  pair.height_px = kHeight;
  pair.left.matrix = pair.right.matrix = scene_.camera({0, 0}).matrix;
  pair.baseline = 1;
  for (std::size_t n = 0; n < kTurns.size(); ++n) {
    const Turn& turn = kTurns[n];
    const std::size_t side = n % 2;
    const PosedCamera camera = posed(pair.left.matrix, Eigen::Matrix3d::Identity(),
                                     {static_cast<double>(side), 0, 0}, turn);
    const Eigen::Matrix3d homography = camera.matrix * camera.rotation * pair.left.matrix.inverse();
    const Photograph truth =
        warped(images[side].image, homography, turn.zoom < 1 ? 6 : 1, cv::BORDER_REPLICATE);
    const Mask mask = inside(homography);
    SynthesizedView view;
    SynthesizedView three_steps;
    ViewSynthesizer({}, execution_)
        .synthesize({images[0].image, images[1].image, images[0].disparity.view(),
                     images[1].disparity.view()},
                    camera_view(pair, camera), view);
    ThreeStepSynthesizer({}, execution_)
        .synthesize({images[0].image, images[1].image, images[0].disparity.view(),
                     images[1].disparity.view()},
                    pair, camera, three_steps);
    const double one_pass_db = psnr(view.image, truth, mask, execution_);
    EXPECT_GE(one_pass_db, turn.zoom < 1 ? 51 : 47) << turn.text();
    EXPECT_GE(one_pass_db, psnr(three_steps.image, truth, mask, execution_) - 0.02) << turn.text();
  }
}

// Brightness, too, is that of the photograph; the other one and all disparities do not matter.
TEST_F(ViewAtCamera, IsThatPhotographWhateverTheOtherShows) {
  const SceneRendering left = scene_.render(SceneView{0, 0}, 0);
  const LayeredScene darker({.width_px = kWidth,
                             .height_px = kHeight,
                             .samples_per_side = 1,
                             .right_gain = 0.7,
                             .right_offset = 9},
                            execution_);
  const SceneRendering right = darker.render(SceneView{1, 0}, 0);
  DisparityMap left_map = left.disparity.copy();
  DisparityMap right_map = right.disparity.copy();
  for (const auto [x, y] : positions_of({50, 120}, {30, 90})) {
    left_map.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    right_map.at(x, y) = std::numeric_limits<float>::infinity();
  }
  const PoseRenderer renderer({}, nullptr, execution_);
  const ViewSource source{left.image, right.image, left_map.view(), right_map.view(), {}};
  SynthesizedView view;
  renderer.render(source, BaselinePosition{0, 0}, view, nullptr);
  EXPECT_TRUE(same(view.image, left.image));
  EXPECT_EQ(view.hole_fraction, 0);
  renderer.render(source, BaselinePosition{1, 0}, view, nullptr);
  EXPECT_TRUE(same(view.image, right.image));
  EXPECT_EQ(view.hole_fraction, 0);
}

// The camera that took a photograph which is not rectified sees that photograph, to the last bit.
TEST_F(ViewAtCamera, OfAnOriginalIsTheOriginal) {
  const RenderedPair raw = unrectified_pair(execution_, kWidth, kHeight);
  const Rectifier rectifier(raw.calibration, kWidth, kHeight);
  const RectifiedPair& cameras = rectifier.pair();
  const PhotographGrid grid(rectifier, execution_);
  // What the maps say does not matter, but they may be anything: cards before a wall.
  DisparityMaps maps;
  for (DisparityMap* map : {&maps.left.disparity_px, &maps.right.disparity_px}) {
    map->resize(kWidth, kHeight);
    for (const auto [x, y] : positions_of(kWidth, kHeight)) {
      map->at(x, y) = (x / 16 + y / 12) % 3 == 0 ? 14.0F : 4.0F + 0.01F * static_cast<float>(x);
    }
  }
  std::array<Image<float>, 2> photograph_maps;
  grid.bring(maps, photograph_maps);
  // The rectified images are not looked at.
  const ViewSource source{raw.left, raw.right, maps.left.disparity_px.view(),
                          maps.right.disparity_px.view(),
                          grid.pair_of(raw.left, raw.right, photograph_maps)};
  const PoseRenderer renderer({}, &cameras, execution_);
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const Photograph& original = side == Side::kLeft ? raw.left : raw.right;
    const Eigen::Matrix3d rotation = cameras.camera(side).rotation.transpose();
    const Eigen::Vector3d centre(side == Side::kLeft ? 0.0 : cameras.baseline, 0, 0);
    for (const Turn& turn :
         {Turn{}, Turn{.zoom = 2}, Turn{.zoom = 0.5}, Turn{.roll = 10, .yaw = 20, .zoom = 0.5}}) {
      const Eigen::Matrix3d& matrix = raw.calibration.left.matrix;
      const PosedCamera camera = posed(matrix, rotation, centre, turn);
      SynthesizedView view;
      renderer.render(source, camera, view, nullptr);
      // Inside the original, also where the rectified image, to which the map belongs, ends before.
      const Eigen::Matrix3d homography = camera.matrix * turn.rotation() * matrix.inverse();
      const Mask mask = inside(homography);
      EXPECT_GE(psnr(view.image,
                     warped(original, homography, turn.zoom < 1 ? 6 : 1, cv::BORDER_REPLICATE),
                     mask, execution_),
                turn.zoom == 1 ? 90 : 47)
          << turn.text();
    }
  }
}

}  // namespace vantage::view_at_camera_test
