#include "engine/rectification/relative_pose.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/calib3d.hpp>

#include "engine/error.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/order_statistics.h"
#include "engine/rectification/rotations.h"
#include "engine/rectification/vertical_error.h"

namespace vantage {
namespace {

constexpr double kMinShareOfMatches = 0.3;
constexpr double kMaxTurn_degrees = 10;
constexpr double kMaxMove_degrees = 30;
constexpr double kSamplingTolerance_px = 2;
constexpr double kDeviationsOfOutliers = 4.5;

constexpr int kParameters = 4;
using PoseParameters = Eigen::Matrix<double, kParameters, 1>;

/// A match as rays (X, Y, 1) of both cameras.
struct RayMatch {
  Eigen::Vector3d left;
  Eigen::Vector3d right;
};

struct Pose {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d direction;  ///< of the translation; of length 1
};

std::vector<RayMatch> rays_of(const StereoCalibration& calibration,
                              const std::vector<PointMatch>& matches) {
  const LensModel left(calibration.left);
  const LensModel right(calibration.right);
  std::vector<RayMatch> rays;
  for (const PointMatch& match : matches) {
    const auto left_ray = left.ray_of(match.left);
    const auto right_ray = right.ray_of(match.right);
    if (left_ray && right_ray) {
      rays.push_back({left_ray->homogeneous(), right_ray->homogeneous()});
    }
  }
  return rays;
}

double mean_focal_px(const StereoCalibration& calibration) {
  return std::sqrt(calibration.left.matrix(0, 0) * calibration.right.matrix(0, 0));
}

/// Sampson distance in rays.
double distance(const Eigen::Matrix3d& essential, const RayMatch& match) {
  const Eigen::Vector3d right_line = essential * match.left;
  const Eigen::Vector3d left_line = essential.transpose() * match.right;
  return match.right.dot(right_line) /
         std::sqrt(right_line.head<2>().squaredNorm() + left_line.head<2>().squaredNorm());
}

/// The axes about which a pose may be turned, in the right camera's frame: along the baseline, and
/// along the mean viewing direction across it. The third one, yaw, moves all disparities and hardly
/// any row: small errors of a lens would look like it.
struct Axes {
  Eigen::Vector3d along;
  Eigen::Vector3d forward;
};

Axes axes_of(const Pose& pose) {
  const Eigen::Vector3d mean_view = Eigen::Vector3d::UnitZ() + pose.rotation.col(2);
  const Eigen::Vector3d across = mean_view - mean_view.dot(pose.direction) * pose.direction;
  return {.along = pose.direction, .forward = across.normalized()};
}

/// `pose` turned by two parameters, its direction moved by two.
Pose moved(const Pose& pose, const Axes& axes, const PoseParameters& by) {
  const Eigen::Matrix3d rotation = rotation_by(by[0] * axes.along + by[1] * axes.forward);
  const Eigen::Vector3d across = pose.direction.unitOrthogonal();
  const Eigen::Vector3d down = pose.direction.cross(across);
  return {.rotation = rotation * pose.rotation,
          .direction = (pose.direction + by[2] * across + by[3] * down).normalized()};
}

Eigen::VectorXd distances(const Pose& pose, const std::vector<RayMatch>& matches) {
  const Eigen::Matrix3d essential = cross_matrix(pose.direction) * pose.rotation;
  Eigen::VectorXd all(static_cast<Eigen::Index>(matches.size()));
  for (std::size_t i = 0; i < matches.size(); ++i) {
    all[static_cast<Eigen::Index>(i)] = distance(essential, matches[i]);
  }
  return all;
}

/// Gauss–Newton with damping for given weights.
Pose fitted(Pose pose, const Axes& axes, const std::vector<RayMatch>& matches,
            const Eigen::VectorXd& weights) {
  constexpr int kSteps = 20;
  constexpr double kDelta = 1e-7;
  double damping = 1e-6;
  const auto cost = [&](const Eigen::VectorXd& residuals) {
    return (weights.array() * residuals.array().square()).sum();
  };
  Eigen::VectorXd residuals = distances(pose, matches);
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix<double, Eigen::Dynamic, kParameters> jacobian(residuals.size(), kParameters);
    for (int k = 0; k < kParameters; ++k) {
      const PoseParameters delta = kDelta * PoseParameters::Unit(k);
      jacobian.col(k) = (distances(moved(pose, axes, delta), matches) -
                         distances(moved(pose, axes, -delta), matches)) /
                        (2 * kDelta);
    }
    const Eigen::Matrix<double, kParameters, kParameters> normal =
        jacobian.transpose() * weights.asDiagonal() * jacobian;
    const PoseParameters gradient = jacobian.transpose() * weights.asDiagonal() * residuals;
    Eigen::Matrix<double, kParameters, kParameters> damped = normal;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12;
    const PoseParameters change = -damped.ldlt().solve(gradient);
    const Pose next = moved(pose, axes, change);
    const Eigen::VectorXd next_residuals = distances(next, matches);
    if (!(cost(next_residuals) < cost(residuals))) {
      damping *= 100;
      if (damping > 1e6) {
        break;
      }
      continue;
    }
    pose = next;
    residuals = next_residuals;
    damping = std::max(damping / 10, 1e-9);
    if (change.norm() < 1e-10) {
      break;
    }
  }
  return pose;
}

/// The matches near the pose that most of them agree with: 1, others 0.
Eigen::VectorXd sampled_inliers(const std::vector<RayMatch>& matches, double tolerance) {
  prepare_opencv();
  std::vector<cv::Point2d> left;
  std::vector<cv::Point2d> right;
  for (const RayMatch& match : matches) {
    left.emplace_back(match.left.x(), match.left.y());
    right.emplace_back(match.right.x(), match.right.y());
  }
  std::vector<std::uint8_t> is_near;
  try {
    (void)cv::findEssentialMat(left, right, cv::Mat::eye(3, 3, CV_64F), cv::USAC_MAGSAC, 0.9999,
                               tolerance, is_near);
  } catch (const cv::Exception&) {
    is_near.clear();  // no sample is plausible
  }
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(matches.size()));
  for (std::size_t i = 0; i < is_near.size() && i < matches.size(); ++i) {
    weights[static_cast<Eigen::Index>(i)] = is_near[i] != 0 ? 1 : 0;
  }
  return weights;
}

int count_of(const Eigen::VectorXd& weights) {
  return static_cast<int>((weights.array() > 0).count());
}

void require_inliers(int inliers, std::size_t matches) {
  const int needed = std::max(
      kMinMatches, static_cast<int>(std::ceil(kMinShareOfMatches * static_cast<double>(matches))));
  if (inliers < needed) {
    throw Error(
        fmt::format("{} of {} points in common agree with one pose of the cameras, expected "
                    "at least {}",
                    inliers, matches, needed));
  }
}

}  // namespace

RefinedPose refine_relative_pose(const StereoCalibration& calibration,
                                 const std::vector<PointMatch>& matches) {
  const std::vector<RayMatch> rays = rays_of(calibration, matches);
  const double focal_px = mean_focal_px(calibration);
  require_inliers(static_cast<int>(rays.size()), matches.size());
  Eigen::VectorXd weights = sampled_inliers(rays, kSamplingTolerance_px / focal_px);
  require_inliers(count_of(weights), matches.size());
  const Pose given = {.rotation = calibration.rotation,
                      .direction = calibration.translation.normalized()};
  const Axes axes = axes_of(given);
  Pose pose = given;
  constexpr int kRounds = 6;
  double rms = 0;
  for (int round = 0; round < kRounds; ++round) {
    pose = fitted(pose, axes, rays, weights);
    const Eigen::VectorXd residuals = distances(pose, rays);
    std::vector<double> near;
    double sum = 0;
    for (Eigen::Index i = 0; i < residuals.size(); ++i) {
      if (weights[i] > 0) {
        near.push_back(std::abs(residuals[i]));
        sum += residuals[i] * residuals[i];
      }
    }
    rms = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(near.size(), 1)));
    require_inliers(static_cast<int>(near.size()), matches.size());
    const double deviation = std::max(1.4826 * upper_median(near), 1e-3 / focal_px);
    const Eigen::ArrayXd share = (residuals.array() / (kDeviationsOfOutliers * deviation)).square();
    weights = (share < 1).select((1 - share).square(), 0);
  }
  RefinedPose result{
      .calibration = calibration, .inliers = count_of(weights), .rms_px = rms * focal_px};
  result.calibration.rotation = pose.rotation;
  result.calibration.translation = calibration.baseline() * pose.direction;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.rotation * given.rotation.transpose()));
  result.turned_degrees = degrees(std::abs(turn.angle()));
  result.moved_degrees = degrees(angle_between(pose.direction, given.direction));
  if (result.turned_degrees > kMaxTurn_degrees || result.moved_degrees > kMaxMove_degrees) {
    throw Error(fmt::format(
        "the images show a pose {:.1f} degrees from the given one, with a baseline {:.1f} degrees "
        "from its direction, expected at most {} and {}",
        result.turned_degrees, result.moved_degrees, kMaxTurn_degrees, kMaxMove_degrees));
  }
  return result;
}

}  // namespace vantage
