#include "engine/synthesis/pose_renderer.h"

#include <variant>

namespace vantage {

PoseRenderer::PoseRenderer(const SynthesisOptions& options, const RectifiedPair* cameras,
                           Execution& execution)
    : cameras_(cameras), synthesizer_(options, execution), three_steps_(options, execution) {}

const PosedCamera* PoseRenderer::three_step_camera(const ViewPose& pose) const {
  return options().warp == WarpColour::kForward && cameras_ != nullptr
             ? std::get_if<PosedCamera>(&pose)
             : nullptr;
}

void PoseRenderer::check(const ViewPose& pose, int width_px, int height_px) const {
  if (const PosedCamera* camera = three_step_camera(pose)) {
    (void)ThreeStepSynthesizer::working_bytes(options(), *cameras_, *camera, 1, 1);
  } else {
    (void)new_view(pose, cameras_, width_px, height_px);
  }
}

void PoseRenderer::render(const ViewSource& source, const ViewPose& pose, SynthesizedView& view,
                          const std::array<IntensityFit, 4>* given_fit) const {
  if (const PosedCamera* camera = three_step_camera(pose)) {
    three_steps_.synthesize(source.left, source.right, source.left_disparity_px,
                            source.right_disparity_px, *cameras_, *camera, view, given_fit);
    return;
  }
  const NewView geometry = new_view(pose, cameras_, source.left.width(), source.left.height());
  if (source.photographs) {
    synthesizer_.synthesize(*source.photographs, source.left_disparity_px,
                            source.right_disparity_px, geometry, view, given_fit);
    return;
  }
  synthesizer_.synthesize(source.left, source.right, source.left_disparity_px,
                          source.right_disparity_px, geometry, view, given_fit);
}

kernels::IntensitySums PoseRenderer::intensity_sums(const ViewSource& source) const {
  const NewView middle = baseline_view(0.5, 0, source.left.width(), source.left.height());
  if (source.photographs) {
    return synthesizer_.intensity_sums(*source.photographs, source.left_disparity_px,
                                       source.right_disparity_px, middle);
  }
  return synthesizer_.intensity_sums(source.left, source.right, source.left_disparity_px,
                                     source.right_disparity_px, middle);
}

}  // namespace vantage
