#include "apps/view_renderer.h"

#include <chrono>
#include <variant>

namespace vantage::apps {

ViewRenderer::ViewRenderer(const PairWithMaps& pair, const SynthesisOptions& options,
                           std::optional<TwoEyes> two_eyes, Execution& execution)
    : pair_(pair),
      two_eyes_(two_eyes),
      synthesizer_(options, execution),
      three_steps_(options, execution) {}

void ViewRenderer::fix_intensities() {
  if (synthesizer_.options().match_intensities) {
    const kernels::IntensitySums sums = synthesizer_.intensity_sums(
        pair_.left, pair_.right, pair_.maps.left.view(), pair_.maps.right.view(), 0.5);
    fit_ = fit_channels(sums, pair_.left.channels(), 1);
  }
}

void ViewRenderer::render(const ViewPose& pose, RenderedView& result) const {
  const auto start = std::chrono::steady_clock::now();
  if (two_eyes_) {
    const double baseline = pair_.cameras ? pair_.cameras->baseline : 0;
    const double half = two_eyes_->separation_baselines / 2;
    synthesize(moved_right(pose, -half, baseline), result.eyes[0]);
    synthesize(moved_right(pose, half, baseline), result.eyes[1]);
    show_stereo(result.eyes[0].image, result.eyes[1].image, two_eyes_->display, result.both);
  } else {
    synthesize(pose, result.eyes[0]);
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void ViewRenderer::synthesize(const ViewPose& pose, SynthesizedView& view) const {
  const auto* camera = std::get_if<PosedCamera>(&pose);
  if (synthesizer_.options().warp == WarpColour::kForward && camera != nullptr && pair_.cameras) {
    three_steps_.synthesize(pair_.left, pair_.right, pair_.maps.left.view(),
                            pair_.maps.right.view(), *pair_.cameras, *camera, view,
                            fit_ ? &*fit_ : nullptr);
    return;
  }
  const NewView geometry = new_view(pose, pair_.cameras ? &*pair_.cameras : nullptr,
                                    pair_.left.width(), pair_.left.height());
  synthesizer_.synthesize(pair_.left, pair_.right, pair_.maps.left.view(), pair_.maps.right.view(),
                          geometry, view, fit_ ? &*fit_ : nullptr);
}

}  // namespace vantage::apps
