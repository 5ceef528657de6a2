#include "engine/scene_graph/posed_viewer.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "engine/error.h"
#include "engine/order_statistics.h"
#include "engine/rectification/rectifier.h"
#include "engine/rectification/rotations.h"
#include "engine/scene_graph/fused_map.h"
#include "engine/scene_graph/scene_viewer.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {
namespace {

constexpr double kMaxTurnOfSource = std::numbers::pi / 3;
constexpr double kMinShare = 1e-3;

/// Median over the edges of the depth in the middle of the disparities that were searched.
double typical_depth_of(const StoredScene& scene) {
  std::vector<double> depths;
  for (const StoredEdge& edge : scene.edges) {
    const double middle_px = 0.5 * (edge.disparities.min + edge.disparities.max);
    if (middle_px > 0) {
      depths.push_back(scene.focal_length_px * edge.edge.length / middle_px);
    }
  }
  return depths.empty() ? scene.unit_length : upper_median(depths);
}

}  // namespace

PosedViewer::PosedViewer(const StoredScene& scene, LoadVertex load_vertex,
                         const SynthesisOptions& options, int sources, Execution& execution)
    : cameras_(scene.cameras()),
      width_px_(scene.width_px),
      height_px_(scene.height_px),
      unit_length_(scene.unit_length),
      scale_px_(scene.focal_length_px * scene.unit_length),
      typical_depth_(typical_depth_of(scene)),
      load_vertex_(std::move(load_vertex)),
      sources_(sources),
      execution_(execution),
      synthesizer_(with_moving_brightness(options), execution),
      blended_(with_moving_brightness(options), execution) {
  if (sources < 1 || sources > kMaxViewSources) {
    throw UsageError(
        fmt::format("sources is {}, expected a number from 1 to {}", sources, kMaxViewSources));
  }
}

PosedCamera PosedViewer::camera_of(int vertex) const {
  const SceneCamera& camera = cameras_.at(static_cast<std::size_t>(vertex));
  return {.matrix = camera.lens.matrix,
          .rotation = camera.pose.rotation,
          .translation = camera.pose.translation,
          .width_px = width_px_,
          .height_px = height_px_};
}

std::vector<std::pair<int, double>> PosedViewer::sources_of(const PosedCamera& camera) const {
  std::vector<std::pair<double, int>> ranked;
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    const double turn = angle_between(camera.rotation.row(2), cameras_[k].pose.rotation.row(2));
    if (turn <= kMaxTurnOfSource) {
      const double distance = (camera.centre() - cameras_[k].pose.centre()).norm();
      ranked.emplace_back(distance + typical_depth_ * turn, static_cast<int>(k));
    }
  }
  std::ranges::sort(ranked);
  const std::size_t count = std::min(ranked.size(), static_cast<std::size_t>(sources_));
  std::vector<std::pair<int, double>> sources;
  for (std::size_t k = 0; k < count; ++k) {
    const double part = count < ranked.size() && ranked[count].first > 0
                            ? ranked[k].first / ranked[count].first
                            : 0;
    sources.emplace_back(ranked[k].second, std::max(1 - part * part, kMinShare));
  }
  std::ranges::sort(sources);
  return sources;
}

void PosedViewer::require_near(const PosedCamera& camera) const {
  camera.validate("camera of the new view");
  if (sources_of(camera).empty()) {
    throw UsageError(
        "camera of the new view looks away from what the images show, expected one turned by at "
        "most 60 degrees from one of them");
  }
  double nearest = HUGE_VAL;
  for (const SceneCamera& image : cameras_) {
    nearest = std::min(nearest, (camera.centre() - image.pose.centre()).norm());
  }
  if (!(nearest <= kMaxViewDistance * unit_length_)) {
    throw UsageError(
        fmt::format("camera of the new view is {:.4g} from the nearest image, expected "
                    "at most {:.4g}, {} median edges",
                    nearest, kMaxViewDistance * unit_length_, kMaxViewDistance));
  }
}

std::shared_ptr<const PosedVertex> PosedViewer::make_vertex(int number) {
  SceneVertex stored = load_vertex_(number);
  auto made = std::make_shared<PosedVertex>();
  made->image = undistorted(std::move(stored.image),
                            cameras_[static_cast<std::size_t>(number)].lens, execution_);
  made->disparity_px.resize(width_px_, height_px_);
  fuse_maps(maps_of(stored), unit_length_, synthesizer_.options().disparity_gradient_limit_px,
            made->disparity_px.view(), execution_);
  return made;
}

std::shared_ptr<const PosedVertex> PosedViewer::vertex(int number) {
  return loaded_.get(number, [&] { return make_vertex(number); });
}

void PosedViewer::load(const PosedCamera& camera) {
  require_near(camera);
  for (const auto& [number, share] : sources_of(camera)) {
    vertex(number);
  }
}

ViewWarp PosedViewer::warp_from(int vertex, const PosedCamera& camera) const {
  return vantage::warp_between(cameras_[static_cast<std::size_t>(vertex)], camera.matrix,
                               {.rotation = camera.rotation, .translation = camera.translation},
                               scale_px_);
}

/// At the first one's camera, so that it does not depend on the view.
const std::array<IntensityFit, 4>& PosedViewer::fit(const PreparedPosedView::Source& first,
                                                    const PreparedPosedView::Source& other) {
  const auto [found, is_new] = fits_.try_emplace({first.vertex, other.vertex});
  if (is_new && first.vertex != other.vertex && synthesizer_.options().match_intensities) {
    NewView view;
    view.width_px = width_px_;
    view.height_px = height_px_;
    const PosedCamera camera = camera_of(first.vertex);
    view.from_right = warp_from(other.vertex, camera);
    const Photograph& image = first.loaded->image;
    found->second = fit_channels(
        synthesizer_.intensity_sums({image, other.loaded->image, first.loaded->disparity_px.view(),
                                     other.loaded->disparity_px.view()},
                                    view),
        image.channels(), 1);
  }
  return found->second;
}

PreparedPosedView PosedViewer::prepare(const PosedCamera& camera) {
  load(camera);
  PreparedPosedView prepared{.camera = camera, .sources = {}};
  for (const auto& [number, share] : sources_of(camera)) {
    prepared.sources.push_back(
        {.vertex = number, .share = share, .loaded = vertex(number), .on_first = {}});
    prepared.sources.back().on_first = fit(prepared.sources.front(), prepared.sources.back());
  }
  return prepared;
}

void PosedViewer::render(const PreparedPosedView& prepared, SynthesizedView& view) const {
  const PosedCamera& camera = prepared.camera;
  std::vector<BlendSource> sources;
  for (const PreparedPosedView::Source& source : prepared.sources) {
    const CameraPose& pose = cameras_[static_cast<std::size_t>(source.vertex)].pose;
    sources.push_back({.image = &source.loaded->image,
                       .disparity_px = source.loaded->disparity_px.view(),
                       .warp = warp_from(source.vertex, camera),
                       .centre = camera.rotation * pose.centre() + camera.translation,
                       .share = source.share,
                       .on_first = source.on_first});
  }
  blended_.synthesize(sources,
                      {.width_px = camera.width_px,
                       .height_px = camera.height_px,
                       .ray_of_pixel = camera.matrix.inverse(),
                       .scale_px = scale_px_},
                      view);
}

}  // namespace vantage
