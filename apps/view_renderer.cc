#include "apps/view_renderer.h"

namespace vantage::apps {

ViewRenderer::ViewRenderer(const PairWithMaps& pair, const SynthesisOptions& options,
                           std::optional<TwoEyes> two_eyes, Execution& execution)
    : source_{pair.left, pair.right, pair.maps.left.view(), pair.maps.right.view(), {}},
      baseline_(pair.cameras ? pair.cameras->baseline : 0),
      two_eyes_(two_eyes),
      renderer_(options, pair.cameras ? &*pair.cameras : nullptr, execution) {
  if (pair.unrectified && options.warp == WarpColour::kOnePass) {
    const UnrectifiedImages& photographs = *pair.unrectified;
    photograph_grid_.emplace(photographs.rectifier, execution);
    photograph_grid_->bring(pair.maps, photograph_maps_);
    source_.photographs.emplace(
        photograph_grid_->pair_of(photographs.left, photographs.right, photograph_maps_));
  }
}

void ViewRenderer::fix_intensities() {
  if (renderer_.options().match_intensities) {
    fit_ = fit_channels(renderer_.intensity_sums(source_), source_.left.channels(), 1);
  }
}

void ViewRenderer::render(const ViewPose& pose, RenderedView& result) const {
  if (two_eyes_) {
    const double half = two_eyes_->separation_baselines / 2;
    synthesize(moved_right(pose, -half, baseline_), result.eyes[0]);
    synthesize(moved_right(pose, half, baseline_), result.eyes[1]);
    show_stereo(result.eyes[0].image, result.eyes[1].image, two_eyes_->display, result.both);
  } else {
    synthesize(pose, result.eyes[0]);
  }
}

void ViewRenderer::synthesize(const ViewPose& pose, SynthesizedView& view) const {
  renderer_.render(source_, pose, view, fit_ ? &*fit_ : nullptr);
}

}  // namespace vantage::apps
