#include "engine/scene_graph/scene_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr double kAlignment = 1e-3;    // of neighbours in a row, relative to their distance
constexpr double kOnBorder = 1e-6;     // of the unit length
constexpr double kFlattest = 1e-3;     // height of a triangle, relative to its longest side
constexpr double kLongestOblique = 2;  // relative to the distance of the nearest neighbour
constexpr float kGridSide = 1000;      // of the positions given to the triangulation
constexpr int kFarAway = 50 * 1000;    // position of its auxiliary vertices

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
  if (count < 2 || count > kMaxVertices) {
    throw Error(fmt::format("scene has {} images, expected 2 to {}", count, kMaxVertices));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(positions_[i].x) || !std::isfinite(positions_[i].y)) {
      throw Error(fmt::format("{}: expected finite numbers", describe(names, positions_, i)));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (positions_[i] == positions_[j]) {
        throw Error(fmt::format("{} has the same position as {}, expected different positions",
                                describe(names, positions_, i), names[j]));
      }
    }
  }
  join_neighbours();
  triangulate();
  join_obliquely();
  unit_length_ = std::min_element(edges_.begin(), edges_.end(), [](const auto& a, const auto& b) {
                   return a.length < b.length;
                 })->length;
  for (const SceneEdge& edge : edges_) {
    pairs_.push_back({edge.first, edge.second});
  }
  for (const auto& [a, b, c] : triangles_) {
    for (const auto& side : {std::array{a, b}, std::array{b, c}, std::array{a, c}}) {
      pairs_.push_back(side);
    }
  }
}

void SceneLayout::join_neighbours() {
  const auto count = static_cast<int>(positions_.size());
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
    }
  };
  for (int vertex = 0; vertex < count; ++vertex) {
    join(vertex, false);
    join(vertex, true);
  }
}

void SceneLayout::join_obliquely() {
  const auto count = static_cast<int>(positions_.size());
  const auto between = [&](int a, int b) {
    return distance(positions_[static_cast<std::size_t>(a)],
                    positions_[static_cast<std::size_t>(b)]);
  };
  std::set<std::array<int, 2>> sides;  // vertices in ascending order
  const auto add_side = [&](int a, int b) { sides.insert({std::min(a, b), std::max(a, b)}); };
  std::vector<double> nearest(positions_.size(), std::numeric_limits<double>::infinity());
  for (int vertex = 0; vertex < count; ++vertex) {
    int neighbour = vertex;
    double& shortest = nearest[static_cast<std::size_t>(vertex)];
    for (int other = 0; other < count; ++other) {
      if (other != vertex && between(vertex, other) < shortest) {
        shortest = between(vertex, other);
        neighbour = other;
      }
    }
    add_side(vertex, neighbour);  // flat triangles were left out, so it need not be on one
  }
  const auto is_near = [&](int vertex, double length) {
    return length <= kLongestOblique * nearest[static_cast<std::size_t>(vertex)];
  };
  std::vector<bool> is_lonely(positions_.size(), true);
  for (const SceneEdge& edge : edges_) {
    for (const int end : {edge.first, edge.second}) {
      if (is_near(end, edge.length)) {
        is_lonely[static_cast<std::size_t>(end)] = false;
      }
    }
  }
  for (const auto& [a, b, c] : triangles_) {
    add_side(a, b);
    add_side(b, c);
    add_side(a, c);
  }
  if (triangles_.empty()) {
    std::vector<int> along_line(positions_.size());
    std::iota(along_line.begin(), along_line.end(), 0);
    std::sort(along_line.begin(), along_line.end(), [&](int a, int b) {
      const ScenePosition& first = positions_[static_cast<std::size_t>(a)];
      const ScenePosition& second = positions_[static_cast<std::size_t>(b)];
      return std::pair(first.x, first.y) < std::pair(second.x, second.y);
    });
    for (std::size_t i = 1; i < along_line.size(); ++i) {
      add_side(along_line[i - 1], along_line[i]);
    }
  }
  for (const auto& [a, b] : sides) {
    const double length = between(a, b);
    const auto wants = [&](int end) {
      return is_lonely[static_cast<std::size_t>(end)] &&
             (triangles_.empty() || is_near(end, length));
    };
    const bool is_edge =
        std::any_of(edges_.begin(), edges_.end(), [&a = a, &b = b](const SceneEdge& edge) {
          return std::min(edge.first, edge.second) == a && std::max(edge.first, edge.second) == b;
        });
    if (!is_edge && (wants(a) || wants(b))) {
      edges_.push_back(oblique_edge(a, b));
    }
  }
  std::sort(edges_.begin(), edges_.end(), [](const SceneEdge& a, const SceneEdge& b) {
    return std::tuple(a.first, a.is_vertical, a.second) <
           std::tuple(b.first, b.is_vertical, b.second);
  });
}

SceneEdge SceneLayout::oblique_edge(int first, int second) const {
  const ScenePosition a = positions_[static_cast<std::size_t>(first)];
  const ScenePosition b = positions_[static_cast<std::size_t>(second)];
  SceneEdge edge{.first = first,
                 .second = second,
                 .is_vertical = std::abs(b.y - a.y) > std::abs(b.x - a.x),
                 .length = distance(a, b)};
  const double along = edge.is_vertical ? b.y - a.y : b.x - a.x;
  const double across = edge.is_vertical ? b.x - a.x : b.y - a.y;
  edge.slope = across / along;
  if (along < 0) {
    std::swap(edge.first, edge.second);
  }
  return edge;
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
