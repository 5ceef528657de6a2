#include "engine/synthesis/pose_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>

namespace vantage {
namespace {

bool is_known(float disparity_px) { return std::isfinite(disparity_px); }

/// The maps of a view at the place of a camera. What that camera's photograph shows is seen
/// wherever it looks, so unknown pixels of its map count as infinitely far away.
class MapsAtCamera {
 public:
  MapsAtCamera(const NewView& view, ViewSource source, Execution& execution)
      : far_(static_cast<float>(view.infinity_disparity_px)),
        execution_(execution),
        source_(std::move(source)) {
    if (view.distance_from_left < kSamePlace) {
      complete(source_.left_disparity_px, 0);
      if (source_.photographs) {
        complete(source_.photographs->left_geometry.disparity_px, 1);
      }
    } else if (view.distance_from_right < kSamePlace) {
      complete(source_.right_disparity_px, 0);
      if (source_.photographs) {
        complete(source_.photographs->right_geometry.disparity_px, 1);
      }
    }
  }

  [[nodiscard]] const ViewSource& source() const { return source_; }

 private:
  void complete(ImageView<const float>& map_px, std::size_t which) {
    const int width = map_px.width();
    const auto is_complete = [&](int y) {
      return std::all_of(map_px.row(y), map_px.row(y) + width, is_known);
    };
    int y = 0;
    while (y < map_px.height() && is_complete(y)) {
      ++y;
    }
    if (y == map_px.height()) {
      return;
    }
    Image<float>& complete = maps_[which];
    complete.resize(width, map_px.height());
    execution_.for_each_band(map_px.height(), [&](int first_row, int end_row) {
      for (int row = first_row; row < end_row; ++row) {
        std::transform(map_px.row(row), map_px.row(row) + width, complete.row(row),
                       [this](float d) { return is_known(d) ? d : far_; });
      }
    });
    map_px = complete.view();
  }

  float far_;
  Execution& execution_;
  ViewSource source_;
  std::array<Image<float>, 2> maps_;  // of the image, of its photograph; empty where not needed
};

}  // namespace

PoseRenderer::PoseRenderer(const SynthesisOptions& options, const RectifiedPair* cameras,
                           Execution& execution)
    : cameras_(cameras),
      execution_(execution),
      synthesizer_(options, execution),
      three_steps_(options, execution) {}

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
  const MapsAtCamera maps(geometry, source, execution_);
  const ViewSource& known = maps.source();
  if (known.photographs) {
    synthesizer_.synthesize(*known.photographs, known.left_disparity_px, known.right_disparity_px,
                            geometry, view, given_fit);
    return;
  }
  synthesizer_.synthesize(known.left, known.right, known.left_disparity_px,
                          known.right_disparity_px, geometry, view, given_fit);
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
