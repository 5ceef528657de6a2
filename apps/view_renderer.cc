#include "apps/view_renderer.h"

#include <variant>

namespace vantage::apps {

ViewRenderer::ViewRenderer(const PairWithMaps& pair, const SynthesisOptions& options,
                           std::optional<TwoEyes> two_eyes, Execution& execution)
    : pair_(pair),
      two_eyes_(two_eyes),
      synthesizer_(options, execution),
      three_steps_(options, execution) {
  if (pair.unrectified && options.warp == WarpColour::kOnePass) {
    photograph_grid_.emplace(pair.unrectified->rectifier, execution);
    photograph_grid_->bring(pair.maps, photograph_maps_);
  }
}

UnrectifiedPair ViewRenderer::unrectified() const {
  return photograph_grid_->pair_of(pair_.unrectified->left, pair_.unrectified->right,
                                   photograph_maps_);
}

void ViewRenderer::fix_intensities() {
  if (synthesizer_.options().match_intensities) {
    const ImageView<const float> left_map = pair_.maps.left.view();
    const ImageView<const float> right_map = pair_.maps.right.view();
    const NewView middle = baseline_view(0.5, 0, pair_.left.width(), pair_.left.height());
    const kernels::IntensitySums sums =
        photograph_grid_
            ? synthesizer_.intensity_sums(unrectified(), left_map, right_map, middle)
            : synthesizer_.intensity_sums(pair_.left, pair_.right, left_map, right_map, middle);
    fit_ = fit_channels(sums, pair_.left.channels(), 1);
  }
}

void ViewRenderer::render(const ViewPose& pose, RenderedView& result) const {
  if (two_eyes_) {
    const double baseline = pair_.cameras ? pair_.cameras->baseline : 0;
    const double half = two_eyes_->separation_baselines / 2;
    synthesize(moved_right(pose, -half, baseline), result.eyes[0]);
    synthesize(moved_right(pose, half, baseline), result.eyes[1]);
    show_stereo(result.eyes[0].image, result.eyes[1].image, two_eyes_->display, result.both);
  } else {
    synthesize(pose, result.eyes[0]);
  }
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
  if (photograph_grid_) {
    synthesizer_.synthesize(unrectified(), pair_.maps.left.view(), pair_.maps.right.view(),
                            geometry, view, fit_ ? &*fit_ : nullptr);
    return;
  }
  synthesizer_.synthesize(pair_.left, pair_.right, pair_.maps.left.view(), pair_.maps.right.view(),
                          geometry, view, fit_ ? &*fit_ : nullptr);
}

}  // namespace vantage::apps
