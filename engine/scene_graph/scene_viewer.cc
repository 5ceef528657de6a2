#include "engine/scene_graph/scene_viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/error.h"
#include "engine/scene_graph/fused_map.h"

namespace vantage {
namespace {

constexpr double kFarthestView = 16;    // edges
constexpr double kSameLength = 1e-9;    // of an edge
constexpr std::size_t kMostLoaded = 8;  // vertices that are kept; a view needs up to three

SynthesisOptions with_moving_brightness(SynthesisOptions options) {
  if (options.warp == WarpColour::kForward) {
    throw UsageError("warp is forward, expected one-pass for views of a scene");
  }
  options.gamma.reset();
  return options;
}

}  // namespace

SceneViewer::SceneViewer(const SceneLayout& layout, LoadVertex load_vertex,
                         const SynthesisOptions& options, Execution& execution)
    : layout_(layout),
      load_vertex_(std::move(load_vertex)),
      execution_(execution),
      synthesizer_(with_moving_brightness(options), execution) {}

// A reference holds until kMostLoaded others have been asked for.
const SceneVertex& SceneViewer::vertex(int number) {
  const auto found = std::find_if(loaded_.begin(), loaded_.end(),
                                  [&](const Loaded& loaded) { return loaded.number == number; });
  if (found != loaded_.end()) {
    loaded_.splice(loaded_.begin(), loaded_, found);
  } else {
    loaded_.push_front({number, load_vertex_(number)});
    if (loaded_.size() > kMostLoaded) {
      loaded_.pop_back();
    }
  }
  return loaded_.front().vertex;
}

ScenePosition SceneViewer::at(int vertex) const {
  return layout_.positions()[static_cast<std::size_t>(vertex)];
}

void SceneViewer::prepare_sources(const ScenePlace& place) {
  const std::vector<int> vertices(place.vertices.begin(), place.vertices.begin() + place.count);
  if (vertices == sources_.vertices) {
    return;
  }
  sources_.vertices.clear();  // until the new ones are complete
  sources_.length = layout_.unit_length();
  if (!place.is_triangle()) {
    for (const SceneEdge& edge : layout_.edges()) {
      if (edge.first == vertices[0] && edge.second == vertices[1]) {
        sources_.length = edge.length;
      }
    }
  }
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const SceneVertex& loaded = vertex(vertices[k]);
    std::vector<MapOfEdge> maps;
    for (const SceneEdgeMap& map : loaded.maps) {
      const bool is_own =
          std::find(vertices.begin(), vertices.end(), map.neighbour) != vertices.end();
      maps.push_back({.disparity_px = map.disparity_px.view(),
                      .is_unmatched = map.unmatched.view(),
                      .edge_length = map.length,
                      .is_own = is_own});
    }
    DisparityMap& fused = sources_.disparity_px[k];
    fused.resize(loaded.image.width(), loaded.image.height());
    fuse_maps(maps, sources_.length, synthesizer_.options().disparity_gradient_limit_px,
              fused.view(), execution_);
  }
  sources_.vertices = vertices;
}

ViewWarp SceneViewer::warp_to(ScenePosition position, int vertex) const {
  const ScenePosition camera = at(vertex);
  ViewWarp warp;
  warp.parallax = {(camera.x - position.x) / sources_.length,
                   (camera.y - position.y) / sources_.length, 0};
  return warp;
}

NewView SceneViewer::pair_view(ScenePosition position, const Photograph& image) const {
  NewView view;
  view.width_px = image.width();
  view.height_px = image.height();
  view.from_left = warp_to(position, sources_.vertices[0]);
  view.from_right = warp_to(position, sources_.vertices[1]);
  view.distance_from_left = view.from_left.parallax.norm();
  view.distance_from_right = view.from_right.parallax.norm();
  // Two images of a row are a rectified pair as they are, without rounding errors: what works along
  // scanlines can then take it.
  const Eigen::Vector3d baseline = view.from_right.parallax - view.from_left.parallax;
  if ((baseline - Eigen::Vector3d::UnitX()).norm() <= kSameLength) {
    const double view_x = -view.from_left.parallax.x();
    view.from_right.parallax = {-(view_x - 1), view.from_left.parallax.y(), 0};
  }
  return view;
}

void SceneViewer::synthesize_pair(ScenePosition position, SynthesizedView& view) {
  const std::vector<int>& ends = sources_.vertices;
  const Photograph& first = vertex(ends[0]).image;
  const Photograph& second = vertex(ends[1]).image;
  const ImageView<const float> first_px = sources_.disparity_px[0].view();
  const ImageView<const float> second_px = sources_.disparity_px[1].view();
  auto fit = pair_fits_.find(ends);
  if (fit == pair_fits_.end()) {
    fit = pair_fits_.emplace(ends, std::array<IntensityFit, 4>()).first;
    if (synthesizer_.options().match_intensities) {
      const ScenePosition middle{(at(ends[0]).x + at(ends[1]).x) / 2,
                                 (at(ends[0]).y + at(ends[1]).y) / 2};
      fit->second = fit_channels(
          synthesizer_.intensity_sums(first, second, first_px, second_px, pair_view(middle, first)),
          first.channels(), 1);
    }
  }
  synthesizer_.synthesize(first, second, first_px, second_px, pair_view(position, first), view,
                          &fit->second);
}

void SceneViewer::synthesize_triangle(const ScenePlace& place, ScenePosition position,
                                      SynthesizedView& view) {
  PhotographTriple triple;
  ScenePosition middle;
  for (std::size_t k = 0; k < 3; ++k) {
    triple.images[k] = &vertex(place.vertices[k]).image;
    triple.disparity_px[k] = sources_.disparity_px[k].view();
    middle.x += at(place.vertices[k]).x / 3;
    middle.y += at(place.vertices[k]).y / 3;
  }
  const auto view_at = [&](ScenePosition seen_from) {
    TripleView geometry;
    geometry.width_px = triple.images[0]->width();
    geometry.height_px = triple.images[0]->height();
    for (std::size_t k = 0; k < 3; ++k) {
      geometry.from[k] = warp_to(seen_from, place.vertices[k]);
    }
    return geometry;
  };
  auto fit = triangle_fits_.find(sources_.vertices);
  if (fit == triangle_fits_.end()) {
    fit =
        triangle_fits_.emplace(sources_.vertices, synthesizer_.fit_triple(triple, view_at(middle)))
            .first;
  }
  TripleView geometry = view_at(position);
  geometry.weights = place.weights;
  synthesizer_.synthesize(triple, geometry, view, fit->second);
}

ScenePlace SceneViewer::synthesize(ScenePosition position, SynthesizedView& view) {
  if (!std::isfinite(position.x) || !std::isfinite(position.y)) {
    throw UsageError("position of the view is not finite, expected two numbers");
  }
  const ScenePlace place = layout_.locate(position);
  prepare_sources(place);
  if (place.is_triangle()) {
    synthesize_triangle(place, position, view);
    return place;
  }
  const double away = std::min(warp_to(position, place.vertices[0]).parallax.norm(),
                               warp_to(position, place.vertices[1]).parallax.norm());
  if (!(away <= kFarthestView)) {
    throw UsageError(fmt::format(
        "view at {},{} is {:.4g} lengths of the nearest edge away from its images, expected at "
        "most {}",
        position.x, position.y, away, kFarthestView));
  }
  synthesize_pair(position, view);
  return place;
}

}  // namespace vantage
