#include "engine/scene_graph/posed_edges.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>
#include <utility>

#include "engine/error.h"
#include "engine/order_statistics.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/rotations.h"

namespace vantage {
namespace {

constexpr double kRadian = std::numbers::pi / 180;
constexpr double kMaxTurn = 45 * kRadian;
constexpr double kMinOffBaseline = 30 * kRadian;
constexpr double kTwiceAsFar = 20 * kRadian;
constexpr double kOneSide = 45 * kRadian;

Eigen::Vector3d viewing_direction(const SceneCamera& camera) { return camera.pose.rotation.row(2); }

struct Candidate {
  std::size_t number = 0;
  double distance = 0;  ///< longer for turned cameras
  Eigen::Vector3d direction;
};

bool can_be_rectified(const SceneCamera& first, const SceneCamera& second, int width_px,
                      int height_px) {
  try {
    (void)rectified_pair(calibration_of(first, second, width_px, height_px), width_px, height_px,
                         {.kept_outline = 0, .any_direction = true});
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// Cameras that look across the line between them, the nearest first.
std::vector<Candidate> candidates_of(std::size_t camera, std::span<const SceneCamera> cameras) {
  std::vector<Candidate> candidates;
  const Eigen::Vector3d own_view = viewing_direction(cameras[camera]);
  const Eigen::Vector3d own_centre = cameras[camera].pose.centre();
  for (std::size_t other = 0; other < cameras.size(); ++other) {
    const Eigen::Vector3d baseline = cameras[other].pose.centre() - own_centre;
    const Eigen::Vector3d view = viewing_direction(cameras[other]);
    const double turn = angle_between(own_view, view);
    const auto off_baseline = [&](const Eigen::Vector3d& direction) {
      const double angle = angle_between(direction, baseline);
      return std::min(angle, std::numbers::pi - angle);
    };
    if (other != camera && turn <= kMaxTurn && off_baseline(own_view) >= kMinOffBaseline &&
        off_baseline(view) >= kMinOffBaseline) {
      candidates.push_back({.number = other,
                            .distance = baseline.norm() * (1 + std::pow(turn / kTwiceAsFar, 2)),
                            .direction = baseline.normalized()});
    }
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::distance);
  return candidates;
}

std::vector<std::size_t> neighbours_of(std::size_t camera, std::span<const SceneCamera> cameras,
                                       int width_px, int height_px, std::size_t count) {
  std::vector<Candidate> chosen;
  std::vector<Candidate> in_same_direction;
  for (const Candidate& candidate : candidates_of(camera, cameras)) {
    if (chosen.size() == count) {
      break;
    }
    const bool is_new_direction = std::ranges::none_of(chosen, [&](const Candidate& nearer) {
      return angle_between(nearer.direction, candidate.direction) < kOneSide;
    });
    if (!is_new_direction && in_same_direction.size() >= count) {
      continue;
    }
    if (can_be_rectified(cameras[camera], cameras[candidate.number], width_px, height_px)) {
      (is_new_direction ? chosen : in_same_direction).push_back(candidate);
    }
  }
  for (const Candidate& candidate : in_same_direction) {
    if (chosen.size() < count) {
      chosen.push_back(candidate);
    }
  }
  std::vector<std::size_t> numbers;
  for (const Candidate& candidate : chosen) {
    numbers.push_back(candidate.number);
  }
  return numbers;
}

void require_different_positions(std::span<const SceneCamera> cameras,
                                 std::span<const std::string> names) {
  std::vector<std::pair<std::array<double, 3>, std::size_t>> places;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Eigen::Vector3d centre = cameras[i].pose.centre();
    places.push_back({{centre.x(), centre.y(), centre.z()}, i});
  }
  std::ranges::sort(places);
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (places[i].first == places[i - 1].first) {
      throw Error(fmt::format("{} and {} have cameras at one position, expected different ones",
                              names[places[i - 1].second], names[places[i].second]));
    }
  }
}

}  // namespace

std::vector<SceneEdge> posed_edges(std::span<const SceneCamera> cameras,
                                   std::span<const std::string> names, int width_px, int height_px,
                                   int neighbours) {
  if (cameras.size() < 2 || cameras.size() > SceneLayout::kMaxVertices) {
    throw Error(fmt::format("the scene has {} images, expected 2 to {}", cameras.size(),
                            SceneLayout::kMaxVertices));
  }
  require_different_positions(cameras, names);
  std::set<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::vector<std::size_t> joined =
        neighbours_of(i, cameras, width_px, height_px, static_cast<std::size_t>(neighbours));
    if (joined.empty()) {
      throw Error(
          fmt::format("{}: no other camera beside it looks the same way, expected one that "
                      "can be rectified with it; leave the image out",
                      names[i]));
    }
    for (const std::size_t j : joined) {
      pairs.insert({static_cast<int>(std::min(i, j)), static_cast<int>(std::max(i, j))});
    }
  }
  std::vector<SceneEdge> edges;
  for (const auto& [first, second] : pairs) {
    const auto centre = [&](int number) {
      return cameras[static_cast<std::size_t>(number)].pose.centre();
    };
    edges.push_back(
        {.first = first, .second = second, .length = (centre(second) - centre(first)).norm()});
  }
  return edges;
}

double median_length(std::span<const SceneEdge> edges) {
  std::vector<double> lengths;
  for (const SceneEdge& edge : edges) {
    lengths.push_back(edge.length);
  }
  return upper_median(lengths);
}

}  // namespace vantage
