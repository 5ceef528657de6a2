#include "engine/scene_graph/scene_viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/error.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {
namespace {

constexpr double kSameDirection = 1e-9;  // of an edge

std::vector<int> vertices_of(const ScenePlace& place) {
  return {place.vertices.begin(), place.vertices.begin() + place.count};
}

PhotographTriple triple_of(const SceneSources& sources) {
  PhotographTriple triple;
  for (std::size_t k = 0; k < 3; ++k) {
    triple.images[k] = &sources.loaded[k]->image;
    triple.disparity_px[k] = sources.disparity_px[k].view();
  }
  return triple;
}

}  // namespace

SynthesisOptions with_moving_brightness(SynthesisOptions options) {
  if (options.warp == WarpColour::kForward) {
    throw UsageError("warp is forward, expected one-pass for views of a scene");
  }
  options.gamma.reset();
  return options;
}

std::vector<MapOfEdge> maps_of(const SceneVertex& vertex) {
  std::vector<MapOfEdge> maps;
  for (const SceneEdgeMap& map : vertex.maps) {
    maps.push_back({.disparity_px = map.disparity_px.view(),
                    .is_unmatched = map.unmatched.view(),
                    .edge_length = map.length});
  }
  return maps;
}

SceneViewer::SceneViewer(const SceneLayout& layout, LoadVertex load_vertex,
                         const SynthesisOptions& options, Execution& execution)
    : layout_(layout),
      load_vertex_(std::move(load_vertex)),
      execution_(execution),
      synthesizer_(with_moving_brightness(options), execution) {}

ScenePosition SceneViewer::at(int vertex) const {
  return layout_.positions()[static_cast<std::size_t>(vertex)];
}

double SceneViewer::length_of(const ScenePlace& place) const {
  if (!place.is_triangle()) {
    for (const SceneEdge& edge : layout_.edges()) {
      if (edge.first == place.vertices[0] && edge.second == place.vertices[1]) {
        return edge.length;
      }
    }
  }
  return layout_.unit_length();
}

void SceneViewer::require_near(ScenePosition position) const {
  if (!std::isfinite(position.x) || !std::isfinite(position.y)) {
    throw UsageError("position of the view is not finite, expected two numbers");
  }
  const ScenePlace place = layout_.locate(position);
  if (place.is_triangle()) {
    return;
  }
  const double length = length_of(place);
  const double away = std::min(warp_to(position, place.vertices[0], length).parallax.norm(),
                               warp_to(position, place.vertices[1], length).parallax.norm());
  if (!(away <= kMaxViewDistance)) {
    throw UsageError(fmt::format(
        "view at {},{} is {:.4g} lengths of the nearest edge away from its images, expected at "
        "most {}",
        position.x, position.y, away, kMaxViewDistance));
  }
}

const std::shared_ptr<const SceneVertex>& SceneViewer::vertex(int number) {
  return loaded_.get(number,
                     [&] { return std::make_shared<const SceneVertex>(load_vertex_(number)); });
}

void SceneViewer::load(ScenePosition position) {
  require_near(position);
  for (const int number : vertices_of(layout_.locate(position))) {
    vertex(number);
  }
}

PreparedSceneView SceneViewer::prepare(ScenePosition position) {
  load(position);
  PreparedSceneView prepared{
      .position = position, .place = layout_.locate(position), .sources = {}};
  prepared.sources =
      sources_.get(vertices_of(prepared.place), [&] { return make_sources(prepared.place); });
  return prepared;
}

std::shared_ptr<const SceneSources> SceneViewer::make_sources(const ScenePlace& place) {
  auto sources = std::make_shared<SceneSources>();
  sources->vertices = vertices_of(place);
  sources->length = length_of(place);
  for (std::size_t k = 0; k < sources->vertices.size(); ++k) {
    sources->loaded[k] = vertex(sources->vertices[k]);
    const SceneVertex& loaded = *sources->loaded[k];
    std::vector<MapOfEdge> maps = maps_of(loaded);
    for (std::size_t i = 0; i < maps.size(); ++i) {
      // Three images show a surface together only where it is at one depth for all of them, which
      // all edges of an image know best.
      maps[i].is_own =
          place.is_triangle() ||
          std::ranges::find(sources->vertices, loaded.maps[i].neighbour) != sources->vertices.end();
    }
    DisparityMap& fused = sources->disparity_px[k];
    fused.resize(loaded.image.width(), loaded.image.height());
    fuse_maps(maps, sources->length, synthesizer_.options().disparity_gradient_limit_px,
              fused.view(), execution_);
  }
  fit_intensities(*sources);
  return sources;
}

void SceneViewer::fit_intensities(SceneSources& sources) {
  ScenePosition middle;
  const auto count = static_cast<double>(sources.vertices.size());
  for (const int number : sources.vertices) {
    middle.x += at(number).x / count;
    middle.y += at(number).y / count;
  }
  if (sources.vertices.size() == 3) {
    auto fit = triple_fits_.find(sources.vertices);
    if (fit == triple_fits_.end()) {
      fit = triple_fits_
                .emplace(sources.vertices,
                         synthesizer_.fit_triple(triple_of(sources), triple_view(sources, middle)))
                .first;
    }
    sources.triple_fit = fit->second;
    return;
  }
  auto fit = pair_fits_.find(sources.vertices);
  if (fit == pair_fits_.end()) {
    fit = pair_fits_.emplace(sources.vertices, std::array<IntensityFit, 4>()).first;
    if (synthesizer_.options().match_intensities) {
      const Photograph& first = sources.loaded[0]->image;
      fit->second = fit_channels(synthesizer_.intensity_sums({first, sources.loaded[1]->image,
                                                              sources.disparity_px[0].view(),
                                                              sources.disparity_px[1].view()},
                                                             pair_view(sources, middle)),
                                 first.channels(), 1);
    }
  }
  sources.pair_fit = fit->second;
}

ViewWarp SceneViewer::warp_to(ScenePosition position, int vertex, double length) const {
  const ScenePosition camera = at(vertex);
  ViewWarp warp;
  warp.parallax = {(camera.x - position.x) / length, (camera.y - position.y) / length, 0};
  return warp;
}

NewView SceneViewer::pair_view(const SceneSources& sources, ScenePosition position) const {
  NewView view;
  view.width_px = sources.loaded[0]->image.width();
  view.height_px = sources.loaded[0]->image.height();
  view.from_left = warp_to(position, sources.vertices[0], sources.length);
  view.from_right = warp_to(position, sources.vertices[1], sources.length);
  view.distance_from_left = view.from_left.parallax.norm();
  view.distance_from_right = view.from_right.parallax.norm();
  // Two images of a row are a rectified pair as they are, without rounding errors, so the scanline
  // warper can be used.
  const Eigen::Vector3d baseline = view.from_right.parallax - view.from_left.parallax;
  if ((baseline - Eigen::Vector3d::UnitX()).norm() <= kSameDirection) {
    const double view_x = -view.from_left.parallax.x();
    view.from_right.parallax = {-(view_x - 1), view.from_left.parallax.y(), 0};
  }
  return view;
}

TripleView SceneViewer::triple_view(const SceneSources& sources, ScenePosition position) const {
  TripleView view;
  view.width_px = sources.loaded[0]->image.width();
  view.height_px = sources.loaded[0]->image.height();
  for (std::size_t k = 0; k < 3; ++k) {
    view.from[k] = warp_to(position, sources.vertices[k], sources.length);
  }
  return view;
}

void SceneViewer::render(const PreparedSceneView& prepared, SynthesizedView& view) const {
  const SceneSources& sources = *prepared.sources;
  if (prepared.place.is_triangle()) {
    TripleView geometry = triple_view(sources, prepared.position);
    geometry.weights = prepared.place.weights;
    synthesizer_.synthesize(triple_of(sources), geometry, view, sources.triple_fit);
    return;
  }
  synthesizer_.synthesize({sources.loaded[0]->image, sources.loaded[1]->image,
                           sources.disparity_px[0].view(), sources.disparity_px[1].view()},
                          pair_view(sources, prepared.position), view, &sources.pair_fit);
}

ScenePlace SceneViewer::synthesize(ScenePosition position, SynthesizedView& view) {
  const PreparedSceneView prepared = prepare(position);
  render(prepared, view);
  return prepared.place;
}

}  // namespace vantage
