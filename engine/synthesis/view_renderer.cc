#include "engine/synthesis/view_renderer.h"

#include <fmt/format.h>

#include <exception>
#include <string>

#include "engine/error.h"

namespace vantage {

ViewRenderer::ViewRenderer(const PairWithMaps& pair, const SynthesisOptions& options,
                           std::optional<TwoEyes> two_eyes, Execution& execution)
    : source_{pair.left,
              pair.right,
              pair.maps.left.disparity_px.view(),
              pair.maps.right.disparity_px.view(),
              {}},
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

std::vector<ViewPose> ViewRenderer::eyes_of(const ViewPose& pose) const {
  if (!two_eyes_) {
    return {pose};
  }
  const double half = two_eyes_->separation_baselines / 2;
  return {moved_right(pose, -half, baseline_), moved_right(pose, half, baseline_)};
}

void ViewRenderer::check(const std::vector<ViewPose>& poses) const {
  for (std::size_t view = 0; view < poses.size(); ++view) {
    const auto text = [&](const std::exception& error) {
      return poses.size() == 1 ? error.what() : fmt::format("view {}: {}", view + 1, error.what());
    };
    try {
      for (const ViewPose& eye : eyes_of(poses[view])) {
        renderer_.check(eye, source_.left.width(), source_.left.height());
      }
    } catch (const UsageError& error) {
      throw UsageError(text(error));
    } catch (const Error& error) {
      throw Error(text(error));
    }
  }
}

void ViewRenderer::render(const ViewPose& pose, RenderedView& result) const {
  const std::vector<ViewPose> eyes = eyes_of(pose);
  for (std::size_t eye = 0; eye < eyes.size(); ++eye) {
    synthesize(eyes[eye], result.eyes[eye]);
  }
  if (two_eyes_) {
    show_stereo(result.eyes[0].image, result.eyes[1].image, two_eyes_->display, result.both);
  }
}

void ViewRenderer::synthesize(const ViewPose& pose, SynthesizedView& view) const {
  renderer_.render(source_, pose, view, fit_ ? &*fit_ : nullptr);
}

}  // namespace vantage
