#include "engine/pose_estimation/camera_positions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr double kMinTrackParallax = 0.01;  // radians between the rays of a track
constexpr double kAngleOfOutliers = 0.004;
constexpr double kWeightOfPointsBehind = 0.01;
constexpr double kMinDepth = 1e-3;  // of the mean distance of the cameras from their middle

/// A ray of a track in the world, and how much it counts.
struct TrackRay {
  int image = 0;
  Eigen::Vector3d direction;
  double weight = 1;
};

using TrackRays = std::vector<TrackRay>;

/// Of each track; removes tracks whose rays are nearly parallel.
std::vector<TrackRays> rays_of(const std::vector<Eigen::Matrix3d>& rotations, double focal_px,
                               std::vector<PointTrack>& tracks) {
  std::vector<TrackRays> all;
  std::erase_if(tracks, [&](const PointTrack& track) {
    TrackRays rays;
    double parallax = 0;
    for (const PointSighting& sighting : track.sightings) {
      const Eigen::Vector3d direction =
          (rotations[static_cast<std::size_t>(sighting.image)].transpose() *
           (sighting.position_px / focal_px).homogeneous())
              .normalized();
      for (const TrackRay& other : rays) {
        parallax = std::max(parallax, direction.cross(other.direction).norm());
      }
      rays.push_back({.image = sighting.image, .direction = direction, .weight = 1});
    }
    if (!(parallax > kMinTrackParallax)) {
      return true;
    }
    for (TrackRay& ray : rays) {
      ray.weight = parallax * parallax;  // as the inverse square of the depth
    }
    all.push_back(std::move(rays));
    return false;
  });
  return all;
}

/// The part of a vector across a ray.
Eigen::Matrix3d across(const TrackRay& ray) {
  return Eigen::Matrix3d::Identity() - ray.direction * ray.direction.transpose();
}

Eigen::Matrix3d sum_of(const TrackRays& track) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const TrackRay& ray : track) {
    sum += ray.weight * across(ray);
  }
  return sum;
}

/// Centres whose rays meet best, of mean 0 and mean square 1.
Eigen::VectorXd solved_centres(std::size_t cameras, const std::vector<TrackRays>& tracks) {
  const auto size = static_cast<Eigen::Index>(3 * cameras);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (const TrackRays& track : tracks) {
    const Eigen::Matrix3d inverse = sum_of(track).inverse();
    for (const TrackRay& ray : track) {
      const Eigen::Matrix3d own = ray.weight * across(ray);
      matrix.block<3, 3>(3 * ray.image, 3 * ray.image) += own;
      for (const TrackRay& other : track) {
        matrix.block<3, 3>(3 * ray.image, 3 * other.image) -=
            own * inverse * (other.weight * across(other));
      }
    }
  }
  // A shift of all cameras changes no ray.
  const double shift = matrix.trace() / static_cast<double>(cameras);
  for (Eigen::Index i = 0; i < size; i += 3) {
    for (Eigen::Index j = 0; j < size; j += 3) {
      matrix.block<3, 3>(i, j).diagonal().array() += shift;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return solver.eigenvectors().col(0) * std::sqrt(static_cast<double>(cameras));
}

Eigen::Vector3d met_point(const TrackRays& track, const Eigen::VectorXd& centres) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TrackRay& ray : track) {
    sum += ray.weight * (across(ray) * centres.segment<3>(3 * ray.image));
  }
  return sum_of(track).ldlt().solve(sum);
}

}  // namespace

std::vector<Eigen::Vector3d> camera_positions(const std::vector<Eigen::Matrix3d>& rotations,
                                              double focal_px, std::vector<PointTrack>& tracks) {
  std::vector<TrackRays> all = rays_of(rotations, focal_px, tracks);
  if (all.size() < rotations.size()) {
    throw Error(
        "the images show no parallax, expected cameras that stand apart: a turn alone tells no "
        "depth");
  }
  constexpr int kRounds = 30;
  Eigen::VectorXd centres;
  for (int round = 0; round < kRounds; ++round) {
    centres = solved_centres(rotations.size(), all);
    std::vector<Eigen::Vector3d> points;
    long long ahead = 0;
    for (const TrackRays& track : all) {
      points.push_back(met_point(track, centres));
      for (const TrackRay& ray : track) {
        ahead += ray.direction.dot(points.back() - centres.segment<3>(3 * ray.image)) > 0 ? 1 : -1;
      }
    }
    const double sign = ahead < 0 ? -1 : 1;
    centres *= sign;
    for (std::size_t i = 0; i < all.size(); ++i) {
      points[i] *= sign;
      tracks[i].point = points[i];
      for (TrackRay& ray : all[i]) {
        const Eigen::Vector3d to_point = points[i] - centres.segment<3>(3 * ray.image);
        const double depth = ray.direction.dot(to_point);
        const double distance = std::max(std::abs(depth), kMinDepth);
        const double angle = (across(ray) * to_point).norm() / distance;
        const double share = angle / kAngleOfOutliers;
        ray.weight =
            (depth > 0 ? 1 : kWeightOfPointsBehind) / (distance * distance * (1 + share * share));
      }
    }
  }
  std::vector<Eigen::Vector3d> result;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    result.emplace_back(centres.segment<3>(static_cast<Eigen::Index>(3 * i)));
  }
  return result;
}

}  // namespace vantage
