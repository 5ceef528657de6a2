#include "engine/synthesis/pose_renderer.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "engine/synthesis/photograph_grid.h"

namespace vantage {
namespace {

bool is_known(float disparity_px) { return std::isfinite(disparity_px); }

/// Whether a view at a camera's position with `homography` (view pixel ← image pixel) stays inside
/// an image of this size.
bool is_within(const Eigen::Matrix3d& homography, const NewView& view,
               ImageView<const float> image) {
  constexpr double kBeyondPx = 0.5 + 1e-3;  // cameras are computed, with rounding errors
  const Eigen::Matrix3d back = homography.inverse();
  for (const double u : {-0.5, view.width_px - 0.5}) {
    for (const double v : {-0.5, view.height_px - 0.5}) {
      const Eigen::Vector3d at = back * Eigen::Vector3d(u, v, 1);
      const Eigen::Vector2d place = at.hnormalized();
      if (!(at.z() > 0 && (place.array() >= -kBeyondPx).all() &&
            place.x() <= image.width() - 1 + kBeyondPx &&
            place.y() <= image.height() - 1 + kBeyondPx)) {
        return false;
      }
    }
  }
  return true;
}

/// Sources of a view at a camera's position. It shows the whole photograph of the camera: unknown
/// pixels of its map count as infinitely far away, and beyond the rectified image the photograph
/// continues (WholePhotograph). Any other view is unchanged.
class SourceAtCamera {
 public:
  SourceAtCamera(const NewView& view, const ViewSource& source, Execution& execution)
      : execution_(execution), view_(view), source_(source) {
    if (view.distance_from_left < kSamePlace) {
      complete(view_.from_left, source_.left_disparity_px,
               source_.photographs ? &source_.photographs->left_geometry : nullptr);
    } else if (view.distance_from_right < kSamePlace) {
      complete(view_.from_right, source_.right_disparity_px,
               source_.photographs ? &source_.photographs->right_geometry : nullptr);
    }
  }

  [[nodiscard]] const NewView& view() const { return view_; }
  [[nodiscard]] const ViewSource& source() const { return source_; }

 private:
  void complete(ViewWarp& warp, ImageView<const float>& map_px, PhotographGeometry* photograph) {
    if (photograph != nullptr && photograph->whole != nullptr &&
        !is_within(warp.homography, view_, map_px)) {
      const WholePhotograph::Window& window = photograph->whole->window();
      map_px = window.disparity_px;
      photograph->positions = window.positions;
      photograph->disparity_px = window.photograph_disparity_px;
      warp.homography.col(2) += warp.homography.leftCols<2>() * window.first_px;
      return;
    }
    fill_unknown(map_px, 0);
    if (photograph != nullptr) {
      fill_unknown(photograph->disparity_px, 1);
    }
  }

  void fill_unknown(ImageView<const float>& map_px, std::size_t which) {
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
    const auto far_px = static_cast<float>(view_.infinity_disparity_px);
    Image<float>& filled = maps_[which];
    filled.resize(width, map_px.height());
    execution_.for_each_row(map_px.height(), [&](int row) {
      std::transform(map_px.row(row), map_px.row(row) + width, filled.row(row),
                     [far_px](float d) { return is_known(d) ? d : far_px; });
    });
    map_px = filled.view();
  }

  Execution& execution_;
  NewView view_;
  ViewSource source_;
  std::array<Image<float>, 2> maps_;  // of the image, of its photograph; empty if not needed
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
    three_steps_.synthesize(source, *cameras_, *camera, view, given_fit);
    return;
  }
  const NewView geometry = new_view(pose, cameras_, source.left.width(), source.left.height());
  const SourceAtCamera seen(geometry, source, execution_);
  synthesizer_.synthesize(seen.source(), seen.view(), view, given_fit);
}

kernels::IntensitySums PoseRenderer::intensity_sums(const ViewSource& source) const {
  return synthesizer_.intensity_sums(source, 0.5);
}

}  // namespace vantage
