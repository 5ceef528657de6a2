#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace vantage {

/// Position of a camera, in any unit common to all: x to the right, y down.
struct ScenePosition {
  double x = 0;
  double y = 0;

  friend bool operator==(const ScenePosition&, const ScenePosition&) = default;
};

/// Two neighbours, whose images are matched: in a row or a column, or obliquely.
struct SceneEdge {
  int first = 0;             ///< vertex on the left, or above
  int second = 0;            ///< vertex on the right, or below
  bool is_vertical = false;  ///< closer to the y direction than to x
  double length = 0;
  /// Slope of an oblique edge, Δy/Δx, or Δx/Δy if is_vertical: within ±1. 0 along rows and columns.
  double slope = 0;

  /// Component of `length` along x, or y if is_vertical.
  [[nodiscard]] double length_along() const { return length / std::sqrt(1 + slope * slope); }

  friend bool operator==(const SceneEdge&, const SceneEdge&) = default;
};

/// Source images of a new view.
struct ScenePlace {
  std::array<int, 3> vertices{};
  int count = 2;                    ///< number of vertices: 2 or 3
  std::array<double, 3> weights{};  ///< shares of the images; each within 0..1, their sum is 1
  bool is_outside = false;          ///< outside the triangle or edge that it is made from

  [[nodiscard]] bool is_triangle() const { return count == 3; }
};

/// A graph of coplanar cameras of equal orientation (3.4): vertices are cameras, edges join
/// neighbours, triangles (Delaunay) fill the interior.
///
/// Thread rule: immutable.
class SceneLayout {
 public:
  static constexpr int kMaxVertices = 4096;

  /// `names`: of the images, for messages. The neighbours of a vertex are the nearest ones in each
  /// direction with the same y or the same x, up to a thousandth of their distance: along such
  /// edges rows, or columns, correspond. A vertex without one within twice the distance of its
  /// nearest vertex is joined obliquely: to all within that distance with which it shares the side
  /// of a triangle, and to the nearest; without triangles to its neighbours on the common line.
  /// Throws Error naming two vertices at one position, or a position that is not finite, and for
  /// fewer than 2 or more than 4096 vertices.
  SceneLayout(std::vector<ScenePosition> positions, std::span<const std::string> names);

  [[nodiscard]] const std::vector<ScenePosition>& positions() const { return positions_; }
  [[nodiscard]] const std::vector<SceneEdge>& edges() const { return edges_; }
  /// Each with its vertices in ascending order; empty if all are collinear.
  [[nodiscard]] const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  /// Length of the shortest edge: the unit baseline of disparities of the whole scene.
  [[nodiscard]] double unit_length() const { return unit_length_; }

  /// The triangle that contains `position` (sides included, within a millionth of unit_length())
  /// with barycentric weights; otherwise the nearest edge, or side of a triangle, with the weights
  /// of (3.14). The first of several.
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
