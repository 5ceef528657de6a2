#include "engine/synthesis/three_step_synthesizer.h"

#include <Eigen/Dense>

#include "engine/evaluation/view_evaluation.h"
#include "engine/generation/layered_scene.h"
#include "engine/view_geometry/new_view.h"
#include "tests/engine/engine_test.h"

namespace vantage::three_step_synthesizer_test {

class ThreeStepSynthesizerTest : public testing::Test {
 protected:
  ThreeStepSynthesizerTest()
      : scene_({.width_px = 320, .height_px = 240, .samples_per_side = 2}, execution_),
        left_(scene_.render(SceneView{0, 0}, 0)),
        right_(scene_.render(SceneView{1, 0}, 0)) {
    pair_.width_px = 320;
    pair_.height_px = 240;
    pair_.left.matrix = pair_.right.matrix = scene_.camera({0, 0}).matrix;
    pair_.baseline = 1;
  }

  PosedCamera camera(const Eigen::Vector3d& centre, double turn) const {
    PosedCamera camera = scene_.camera({0, 0});
    camera.rotation = (Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd(-turn / 2, Eigen::Vector3d::UnitX()))
                          .toRotationMatrix();
    camera.translation = -camera.rotation * centre;
    return camera;
  }
  SynthesizedView three_steps(const PosedCamera& camera, const SynthesisOptions& options) {
    SynthesizedView view;
    ThreeStepSynthesizer(options, execution_)
        .synthesize({left_.image, right_.image, left_.disparity.view(), right_.disparity.view()},
                    pair_, camera, view);
    return view;
  }
  SynthesizedView one_pass(const PosedCamera& camera) {
    SynthesizedView view;
    ViewSynthesizer({}, execution_)
        .synthesize({left_.image, right_.image, left_.disparity.view(), right_.disparity.view()},
                    camera_view(pair_, camera), view);
    return view;
  }

  Execution execution_{{}};
  LayeredScene scene_;
  SceneRendering left_;
  SceneRendering right_;
  RectifiedPair pair_;
};

Mask inverted(const Mask& mask) {
  Mask result = mask.copy();
  for (const auto [x, y] : positions_of(mask)) {
    result.at(x, y) = static_cast<std::uint8_t>(255 - mask.at(x, y));
  }
  return result;
}

TEST_F(ThreeStepSynthesizerTest, SeesWhatTheCameraSeesButLessSharplyThanInOnePass) {
  const PosedCamera cameras[] = {camera({0.4, 0.5, 0}, 0.06), camera({0.5, -0.3, 0.04}, -0.05)};
  for (const PosedCamera& camera : cameras) {
    const Photograph truth = scene_.render(camera, 0).image;
    const SynthesizedView view = three_steps(camera, {.warp = WarpColour::kForward});
    const SynthesizedView best = one_pass(camera);
    EXPECT_EQ(view.image.width(), 320);
    EXPECT_NEAR(view.hole_fraction, best.hole_fraction, 0.02);
    const Mask visible = inverted(best.holes);
    const double psnr = evaluate_view(view.image, truth, execution_, visible.view()).psnr_db;
    const double best_psnr = evaluate_view(best.image, truth, execution_, visible.view()).psnr_db;
    EXPECT_GT(psnr, 30);
    EXPECT_GT(best_psnr, psnr + 1);
  }
}

// On the baseline the second step knows outlines to fractions of a pixel.
TEST_F(ThreeStepSynthesizerTest, TurnsACameraOnTheBaseline) {
  const PosedCamera turned = camera({0.5, 0, 0}, 0.05);
  const SynthesizedView view = three_steps(turned, {});
  const Mask visible = inverted(view.holes);
  EXPECT_GT(
      evaluate_view(view.image, scene_.render(turned, 0).image, execution_, visible.view()).psnr_db,
      35);
}

TEST_F(ThreeStepSynthesizerTest, ACameraLikeThePairsOnTheirBaselineNeedsOneStep) {
  const PosedCamera middle = scene_.camera({0.5, 0});
  const SynthesizedView view = three_steps(middle, {.warp = WarpColour::kForward});
  SynthesizedView expected;
  ViewSynthesizer({.warp = WarpColour::kForward}, execution_)
      .synthesize({left_.image, right_.image, left_.disparity.view(), right_.disparity.view()}, 0.5,
                  expected);
  // Homographies are the identity but for rounding, which interpolation may round up or down.
  const ViewScores scores = evaluate_view(view.image, expected.image, execution_);
  EXPECT_GT(scores.psnr_db, 55);
}

TEST_F(ThreeStepSynthesizerTest, IsTheSameForAnyNumberOfThreads) {
  const PosedCamera turned = camera({0.4, 0.5, 0}, 0.06);
  const SynthesizedView view = three_steps(turned, {});
  Execution serial({.threads = 1, .executor = scheduler::ExecutorKind::kSerial});
  SynthesizedView other;
  ThreeStepSynthesizer({}, serial)
      .synthesize({left_.image, right_.image, left_.disparity.view(), right_.disparity.view()},
                  pair_, turned, other);
  EXPECT_TRUE(test::same(view.image, other.image));
}

TEST_F(ThreeStepSynthesizerTest, ACameraAheadHasAPlaneThatCutsTheScene) {
  const PosedCamera ahead = camera({0.5, 0, 1}, 0);
  EXPECT_NE(error_of([&] { three_steps(ahead, {}); }).find("plane through the three cameras"),
            std::string::npos);
  EXPECT_NO_THROW(one_pass(ahead));
}

}  // namespace vantage::three_step_synthesizer_test
