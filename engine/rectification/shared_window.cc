#include "engine/rectification/shared_window.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage {
namespace {

constexpr int kDirections = 512;

Eigen::Array2d half_extent_px(int width_px, int height_px) {
  return Eigen::Array2d(width_px, height_px) / 2;
}

bool is_inside(const RayPolygon& polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  Eigen::Vector2d previous = polygon.back();
  for (const Eigen::Vector2d& corner : polygon) {
    if ((corner.y() > point.y()) != (previous.y() > point.y()) &&
        point.x() < previous.x() + (corner.x() - previous.x()) * (point.y() - previous.y()) /
                                       (corner.y() - previous.y())) {
      inside = !inside;
    }
    previous = corner;
  }
  return inside;
}

struct Box {
  Eigen::Array2d low;
  Eigen::Array2d high;
};

Box bounds(const RayPolygon& polygon) {
  Box box{polygon[0].array(), polygon[0].array()};
  for (const Eigen::Vector2d& corner : polygon) {
    box.low = box.low.min(corner.array());
    box.high = box.high.max(corner.array());
  }
  return box;
}

/// Minimum of max(|x|, |y|) on the line from `a` to `b`. Convex, so it is at an end or a kink.
double min_extent(const Eigen::Array2d& a, const Eigen::Array2d& b, double limit) {
  double min = std::min(a.abs().maxCoeff(), b.abs().maxCoeff());
  const Eigen::Array2d line = b - a;
  if (min - line.abs().maxCoeff() >= limit) {
    return min;
  }
  const auto look_at = [&](double distance, double slope) {
    const double t = -distance / slope;
    if (t > 0 && t < 1) {
      min = std::min(min, (a + t * line).abs().maxCoeff());
    }
  };
  look_at(a.x(), line.x());
  look_at(a.y(), line.y());
  look_at(a.x() - a.y(), line.x() - line.y());
  look_at(a.x() + a.y(), line.x() + line.y());
  return min;
}

/// The largest scale of a window around `centre`: it grows until it touches a polygon.
double largest_scale(const std::array<RayPolygon, 2>& polygons, const Eigen::Vector2d& centre,
                     const Eigen::Array2d& half_px) {
  double scale = std::numeric_limits<double>::infinity();
  for (const RayPolygon& polygon : polygons) {
    if (!is_inside(polygon, centre)) {
      return 0;
    }
    Eigen::Array2d previous = (polygon.back() - centre).array() / half_px;
    for (const Eigen::Vector2d& corner : polygon) {
      const Eigen::Array2d next = (corner - centre).array() / half_px;
      scale = std::min(scale, min_extent(previous, next, scale));
      previous = next;
    }
  }
  return scale;
}

}  // namespace

RayPolygon seen_rays(const LensModel& lens, int width_px, int height_px) {
  const auto is_seen = [&](const Eigen::Vector2d& ray) {
    const auto position = lens.position_of(ray);
    return position && position->x() >= -0.5 && position->x() <= width_px - 0.5 &&
           position->y() >= -0.5 && position->y() <= height_px - 0.5;
  };
  // Evenly spaced, plus the corners of the image, where the outline has its own.
  std::vector<double> angles;
  angles.reserve(kDirections + 4);
  for (int i = 0; i < kDirections; ++i) {
    angles.push_back(2 * std::numbers::pi * i / kDirections - std::numbers::pi);
  }
  for (const double x : {-0.5, width_px - 0.5}) {
    for (const double y : {-0.5, height_px - 0.5}) {
      if (const auto ray = lens.ray_of({x, y})) {
        angles.push_back(std::atan2(ray->y(), ray->x()));
      }
    }
  }
  std::sort(angles.begin(), angles.end());

  RayPolygon polygon;
  constexpr int kSteps = 64;
  const double step = lens.largest_ray() / kSteps;  // 0 if the lens folds back at once
  for (const double angle : angles) {
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    int steps = 0;
    while (steps < kSteps && is_seen((steps + 1) * step * direction)) {
      ++steps;
    }
    double inside = steps * step;
    double outside = std::min(inside + step, lens.largest_ray());
    for (int halving = 0; halving < 32; ++halving) {
      const double middle = (inside + outside) / 2;
      (is_seen(middle * direction) ? inside : outside) = middle;
    }
    polygon.emplace_back(inside * direction);
  }
  return polygon;
}

std::optional<RayPolygon> turned(const RayPolygon& polygon, const Eigen::Matrix3d& rotation) {
  constexpr double kMinCosine = 0.087;  // cos 85°
  RayPolygon result;
  result.reserve(polygon.size());
  for (const Eigen::Vector2d& ray : polygon) {
    const Eigen::Vector3d point = rotation * ray.homogeneous();
    if (!(point.z() >= kMinCosine * point.norm())) {
      return std::nullopt;
    }
    result.push_back(point.hnormalized());
  }
  return result;
}

std::optional<RayWindow> largest_window_inside(const std::array<RayPolygon, 2>& polygons,
                                               int width_px, int height_px) {
  constexpr int kGrid = 12;  // intervals per side of the first search
  constexpr int kSteps = 48;
  const Eigen::Array2d half_px = half_extent_px(width_px, height_px);
  const Box a = bounds(polygons[0]);
  const Box b = bounds(polygons[1]);
  const Eigen::Array2d low = a.low.max(b.low);
  const Eigen::Array2d high = a.high.min(b.high);
  if (!(low < high).all()) {
    return std::nullopt;
  }
  const Eigen::Array2d middle = (low + high) / 2;
  RayWindow best;
  double best_value = 0;
  const auto attempt = [&](const Eigen::Array2d& centre) {
    const double scale = largest_scale(polygons, centre.matrix(), half_px);
    // Among windows equally large up to a ten thousandth, the one closest to the middle.
    const double value = scale - 1e-4 * ((centre - middle).abs() / half_px).maxCoeff();
    if (scale > 0 && value > best_value) {
      best_value = value;
      best = {.centre = centre.matrix(), .scale = scale};
    }
  };
  Eigen::Array2d step = (high - low) / kGrid;
  for (int row = 0; row <= kGrid; ++row) {
    for (int column = 0; column <= kGrid; ++column) {
      attempt(low + step * Eigen::Array2d(column, row));
    }
  }
  // Hill climbing among the eight neighbours; each maximum halves the step.
  for (int i = 0; i < kSteps && best_value > 0; ++i) {
    const Eigen::Array2d centre = best.centre.array();
    const double value = best_value;
    for (int row = -1; row <= 1; ++row) {
      for (int column = -1; column <= 1; ++column) {
        attempt(centre + step * Eigen::Array2d(column, row));
      }
    }
    if (best_value == value) {
      step /= 2;
    }
  }
  return best_value > 0 ? std::optional(best) : std::nullopt;
}

RayWindow smallest_window_around(const std::array<RayPolygon, 2>& polygons, int width_px,
                                 int height_px) {
  const Box a = bounds(polygons[0]);
  const Box b = bounds(polygons[1]);
  const Eigen::Array2d low = a.low.min(b.low);
  const Eigen::Array2d high = a.high.max(b.high);
  return {.centre = ((low + high) / 2).matrix(),
          .scale = ((high - low) / 2 / half_extent_px(width_px, height_px)).maxCoeff()};
}

}  // namespace vantage
