#include "engine/scene_graph/scene_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr double kAlignment = 1e-3;  // of neighbours in a row, relative to their distance
constexpr double kOnBorder = 1e-6;   // of the unit length
constexpr double kFlattest = 1e-3;   // height of a triangle, relative to its longest side
constexpr float kGridSide = 1000;    // of the positions as the triangulation gets them
constexpr int kFarAway = 50 * 1000;  // where its own auxiliary vertices lie

double distance(ScenePosition a, ScenePosition b) { return std::hypot(b.x - a.x, b.y - a.y); }

double cross(ScenePosition origin, ScenePosition a, ScenePosition b) {
  return (a.x - origin.x) * (b.y - origin.y) - (a.y - origin.y) * (b.x - origin.x);
}

std::string describe(std::span<const std::string> names, std::span<const ScenePosition> positions,
                     std::size_t vertex) {
  return fmt::format("{} at {},{}", names[vertex], positions[vertex].x, positions[vertex].y);
}

bool is_flat(const std::array<ScenePosition, 3>& corners) {
  const double longest =
      std::max({distance(corners[0], corners[1]), distance(corners[1], corners[2]),
                distance(corners[2], corners[0])});
  return std::abs(cross(corners[0], corners[1], corners[2])) <= kFlattest * longest * longest;
}

double distance_to_segment(ScenePosition p, ScenePosition a, ScenePosition b) {
  const double length = distance(a, b);
  const double along = ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / (length * length);
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p.x - (a.x + t * (b.x - a.x)), p.y - (a.y + t * (b.y - a.y)));
}

}  // namespace

SceneLayout::SceneLayout(std::vector<ScenePosition> positions, std::span<const std::string> names)
    : positions_(std::move(positions)) {
  const std::size_t count = positions_.size();
  if (count < 2 || count > kMostVertices) {
    throw Error(fmt::format("scene has {} images, expected 2 to {}", count, kMostVertices));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(positions_[i].x) || !std::isfinite(positions_[i].y)) {
      throw Error(fmt::format("{}: expected finite numbers", describe(names, positions_, i)));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (positions_[i] == positions_[j]) {
        throw Error(fmt::format("{} is where {} is, expected different positions",
                                describe(names, positions_, i), names[j]));
      }
    }
  }
  join_neighbours(names);
  triangulate();
  for (const SceneEdge& edge : edges_) {
    pairs_.push_back({edge.first, edge.second});
  }
  for (const auto& [a, b, c] : triangles_) {
    for (const auto& side : {std::array{a, b}, std::array{b, c}, std::array{a, c}}) {
      pairs_.push_back(side);
    }
  }
}

void SceneLayout::join_neighbours(std::span<const std::string> names) {
  const auto count = static_cast<int>(positions_.size());
  std::vector<bool> is_joined(positions_.size());
  const auto join = [&](int first, bool is_vertical) {
    // The nearest one straight to the right, or below.
    SceneEdge nearest{.first = first,
                      .second = -1,
                      .is_vertical = is_vertical,
                      .length = std::numeric_limits<double>::infinity()};
    const ScenePosition from = positions_[static_cast<std::size_t>(first)];
    for (int second = 0; second < count; ++second) {
      const ScenePosition to = positions_[static_cast<std::size_t>(second)];
      const double along = is_vertical ? to.y - from.y : to.x - from.x;
      const double across = is_vertical ? to.x - from.x : to.y - from.y;
      const double length = distance(from, to);
      if (along > 0 && std::abs(across) <= kAlignment * along && length < nearest.length) {
        nearest.second = second;
        nearest.length = length;
      }
    }
    if (nearest.second >= 0) {
      edges_.push_back(nearest);
      is_joined[static_cast<std::size_t>(first)] = true;
      is_joined[static_cast<std::size_t>(nearest.second)] = true;
    }
  };
  for (int vertex = 0; vertex < count; ++vertex) {
    join(vertex, false);
    join(vertex, true);
  }
  const auto lonely = std::find(is_joined.begin(), is_joined.end(), false);
  if (lonely != is_joined.end()) {
    throw Error(fmt::format(
        "{} has no neighbour at the same x or the same y, expected images in "
        "rows, columns or a grid",
        describe(names, positions_, static_cast<std::size_t>(lonely - is_joined.begin()))));
  }
  unit_length_ = std::min_element(edges_.begin(), edges_.end(), [](const auto& a, const auto& b) {
                   return a.length < b.length;
                 })->length;
}

void SceneLayout::triangulate() {
  const auto [left, right] = std::minmax_element(
      positions_.begin(), positions_.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto [top, bottom] = std::minmax_element(
      positions_.begin(), positions_.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  const double side = std::max(right->x - left->x, bottom->y - top->y);
  cv::Subdiv2D subdivision(cv::Rect(-kFarAway, -kFarAway, 2 * kFarAway, 2 * kFarAway));
  std::map<int, int> vertex_of_point;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const double scale = kGridSide / side;
    const int point =
        subdivision.insert(cv::Point2f(static_cast<float>((positions_[i].x - left->x) * scale),
                                       static_cast<float>((positions_[i].y - top->y) * scale)));
    vertex_of_point[point] = static_cast<int>(i);
  }
  std::vector<int> leading_edges;
  subdivision.getLeadingEdgeList(leading_edges);
  for (int edge : leading_edges) {
    std::array<int, 3> vertices{};
    bool is_inner = true;
    for (int& vertex : vertices) {
      const auto found = vertex_of_point.find(subdivision.edgeOrg(edge));
      is_inner = is_inner && found != vertex_of_point.end();
      vertex = is_inner ? found->second : 0;
      edge = subdivision.getEdge(edge, cv::Subdiv2D::NEXT_AROUND_LEFT);
    }
    const auto at = [&](std::size_t k) {
      return positions_[static_cast<std::size_t>(vertices[k])];
    };
    if (is_inner && !is_flat({at(0), at(1), at(2)})) {
      std::sort(vertices.begin(), vertices.end());
      triangles_.push_back(vertices);
    }
  }
  std::sort(triangles_.begin(), triangles_.end());
  triangles_.erase(std::unique(triangles_.begin(), triangles_.end()), triangles_.end());
}

ScenePlace SceneLayout::locate(ScenePosition position) const {
  for (const std::array<int, 3>& vertices : triangles_) {
    const ScenePosition a = positions_[static_cast<std::size_t>(vertices[0])];
    const ScenePosition b = positions_[static_cast<std::size_t>(vertices[1])];
    const ScenePosition c = positions_[static_cast<std::size_t>(vertices[2])];
    const double area = cross(a, b, c);
    std::array<double, 3> weights = {cross(position, b, c) / area, cross(position, c, a) / area,
                                     cross(position, a, b) / area};
    // Distance from a side is weight · height = weight · area / side.
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    const double slack = kOnBorder * unit_length_ * longest / std::abs(area);
    if (std::all_of(weights.begin(), weights.end(), [&](double w) { return w >= -slack; })) {
      double sum = 0;
      for (double& weight : weights) {
        weight = weight <= slack ? 0 : weight;
        sum += weight;
      }
      for (double& weight : weights) {
        weight /= sum;
      }
      return {.vertices = vertices, .count = 3, .weights = weights};
    }
  }
  return nearest_pair(position);
}

ScenePlace SceneLayout::nearest_pair(ScenePosition position) const {
  ScenePlace place;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [first, second] : pairs_) {
    const ScenePosition a = positions_[static_cast<std::size_t>(first)];
    const ScenePosition b = positions_[static_cast<std::size_t>(second)];
    const double away = distance_to_segment(position, a, b);
    if (away < nearest) {
      nearest = away;
      const double from_first = distance(a, position);
      const double from_second = distance(b, position);
      const double share = from_second / (from_first + from_second);
      place.vertices = {first, second, 0};
      place.weights = {share, 1 - share, 0};
    }
  }
  place.is_outside = nearest > kOnBorder * unit_length_;
  return place;
}

}  // namespace vantage
