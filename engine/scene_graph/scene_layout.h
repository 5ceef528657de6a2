#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace vantage {

/// Where a camera stands, in any unit that all share: x to the right, y down.
struct ScenePosition {
  double x = 0;
  double y = 0;

  friend bool operator==(const ScenePosition&, const ScenePosition&) = default;
};

/// Two neighbours, whose images are matched: in a row or a column, or obliquely.
struct SceneEdge {
  int first = 0;             ///< vertex on the left, or above
  int second = 0;            ///< vertex on the right, or below
  bool is_vertical = false;  ///< rather along y than along x
  double length = 0;
  /// Of an oblique edge, Δy/Δx, or Δx/Δy if is_vertical: within ±1. 0 along rows and columns.
  double slope = 0;

  /// Part of `length` that is along x, or y if is_vertical.
  [[nodiscard]] double length_along() const { return length / std::sqrt(1 + slope * slope); }

  friend bool operator==(const SceneEdge&, const SceneEdge&) = default;
};

/// What a new view is made from.
struct ScenePlace {
  std::array<int, 3> vertices{};
  int count = 2;                    ///< of the vertices: 2 or 3
  std::array<double, 3> weights{};  ///< shares of the images; each within 0..1, their sum is 1
  bool is_outside = false;          ///< off the triangle or edge it is made from

  [[nodiscard]] bool is_triangle() const { return count == 3; }
};

/// A graph of cameras that stand in one plane and look the same way (3.4): vertices are cameras,
/// edges join neighbours, triangles (Delaunay) fill what cameras enclose.
///
/// Thread rule: immutable.
class SceneLayout {
 public:
  static constexpr int kMostVertices = 4096;

  /// `names`: of the images, for messages. The neighbours of a vertex are the nearest ones with the
  /// same y or the same x, up to a thousandth of their distance, in each direction: along such
  /// edges rows, or columns, correspond. A vertex that has none within twice the distance of the
  /// vertex nearest to it is joined obliquely: to all within that distance with which it shares the
  /// side of a triangle, and to the nearest; without triangles to those before and behind it on the
  /// line that all stand on. Throws Error naming two vertices at one place, or a position that is
  /// not finite, and for fewer than 2 or more than 4096 vertices.
  SceneLayout(std::vector<ScenePosition> positions, std::span<const std::string> names);

  [[nodiscard]] const std::vector<ScenePosition>& positions() const { return positions_; }
  [[nodiscard]] const std::vector<SceneEdge>& edges() const { return edges_; }
  /// Each with its vertices in ascending order; none where all stand on one line.
  [[nodiscard]] const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  /// Length of the shortest edge: what disparities of the whole scene are counted for.
  [[nodiscard]] double unit_length() const { return unit_length_; }

  /// The triangle that holds `position` (its sides included, within a millionth of unit_length())
  /// with barycentric weights; else the edge, or side of a triangle, that is nearest, with the
  /// weights of (3.14). The first of several.
  [[nodiscard]] ScenePlace locate(ScenePosition position) const;

 private:
  void join_neighbours();
  void join_obliquely();
  [[nodiscard]] SceneEdge oblique_edge(int first, int second) const;
  void triangulate();
  [[nodiscard]] ScenePlace nearest_pair(ScenePosition position) const;

  std::vector<ScenePosition> positions_;
  std::vector<SceneEdge> edges_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 2>> pairs_;  // edges and sides of triangles
  double unit_length_ = 1;
};

}  // namespace vantage
