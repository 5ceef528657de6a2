#include "engine/rectification/rig_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "engine/rectification/rotations.h"
#include "scheduler/interruption.h"

namespace vantage {
namespace {

/// The parameters, each in units of its prior standard deviation.
enum Parameter {
  kFocal,        // logarithm of the focal length over the usual one, of both cameras
  kFocalRatio,   // logarithm of right over left
  kLeftCentreX,  // principal point, offset from the image's centre, over the longer side
  kLeftCentreY,
  kRightCentreX,
  kRightCentreY,
  kDistortion,            // k4 of both cameras, for rays of the usual focal length
  kDistortionDifference,  // right − left
  kTurnX,                 // rotation vector, right ← left
  kTurnY,
  kTurnZ,
  kBaselineUp,      // angle of the baseline out of the x-z plane
  kBaselineForward  // angle of the baseline out of the x-y plane
};

constexpr std::array<double, RigModel::kParameters> kUsual = {
    0.25, 0.05, 0.03, 0.03, 0.03, 0.03, 0.15, 0.02, 0.1, 0.05, 0.1, 0.1, 0.1};
/// Over the longer side; a field of view of 49 degrees.
constexpr double kUsualFocal = 1.1;

/// An undistorted position, and the local magnification of the photograph there.
struct IdealPosition {
  Eigen::Vector3d ray;
  double magnification;
};

/// A lens that maps the ray r to r / (1 + k4 r²), which has a closed-form inverse.
struct SimpleCamera {
  double focal_px;
  Eigen::Vector2d centre_px;
  double k4;

  [[nodiscard]] IdealPosition ideal(const Eigen::Vector2d& position_px) const {
    const Eigen::Vector2d seen = (position_px - centre_px) / focal_px;
    // Beyond the fold there is no ray; the last one keeps the distance continuous.
    const double root = std::sqrt(std::max(1 - 4 * k4 * seen.squaredNorm(), 0.0));
    const double stretch = 2 / (1 + root);
    return {(stretch * seen).homogeneous(), 1 / stretch};
  }
  [[nodiscard]] Eigen::Vector2d position(const Eigen::Vector3d& ray) const {
    const Eigen::Vector2d plane = ray.hnormalized();
    return plane / std::max(1 + k4 * plane.squaredNorm(), 0.1) * focal_px + centre_px;
  }
  [[nodiscard]] Camera camera() const {
    Camera result;
    result.matrix << focal_px, 0, centre_px.x(), 0, focal_px, centre_px.y(), 0, 0, 1;
    result.distortion = {0, 0, 0, 0, 0, k4, 0, 0};
    return result;
  }
};

/// Residuals for the minimiser: those of matches, then the parameters themselves.
struct Problem {
  const RigModel::Residuals& residuals_of;
  Eigen::Index residuals;

  [[nodiscard]] Eigen::Index inputs() const { return RigModel::kParameters; }
  [[nodiscard]] Eigen::Index values() const { return residuals + RigModel::kParameters; }
  int operator()(const Eigen::VectorXd& parameters, Eigen::VectorXd& values) const {
    scheduler::check_interruption();
    values.head(residuals) = residuals_of(parameters);
    values.tail(RigModel::kParameters) = parameters;
    return 0;
  }
  int df(const Eigen::VectorXd& parameters, Eigen::MatrixXd& jacobian) const {
    // All parameters are of the order of 1, even if their value is 0.
    constexpr double kStep = 1e-4;
    for (int i = 0; i < RigModel::kParameters; ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(RigModel::kParameters, i);
      jacobian.col(i).head(residuals) =
          (residuals_of(parameters + step) - residuals_of(parameters - step)) / (2 * kStep);
    }
    jacobian.bottomRows<RigModel::kParameters>().setIdentity();
    return 0;
  }
};

}  // namespace

struct RigModel::Cameras {
  SimpleCamera left;
  SimpleCamera right;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
};

RigModel::RigModel(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {}

RigModel::Cameras RigModel::cameras(const Parameters& parameters) const {
  const auto value = [&](Parameter which) {
    return parameters[which] * kUsual[static_cast<std::size_t>(which)];
  };
  const double side_px = std::max(width_px_, height_px_);
  const auto camera = [&](double sign, Parameter centre_x, Parameter centre_y) {
    const double focal = std::exp(value(kFocal) + sign / 2 * value(kFocalRatio));
    return SimpleCamera{
        .focal_px = kUsualFocal * side_px * focal,
        .centre_px = {(width_px_ - 1) / 2 + side_px * value(centre_x),
                      (height_px_ - 1) / 2 + side_px * value(centre_y)},
        // Scaled so that curvature in the image does not depend on the focal length.
        .k4 = (value(kDistortion) + sign / 2 * value(kDistortionDifference)) * focal * focal};
  };
  const double up = value(kBaselineUp);
  const double forward = value(kBaselineForward);
  return {.left = camera(-1, kLeftCentreX, kLeftCentreY),
          .right = camera(1, kRightCentreX, kRightCentreY),
          .rotation = rotation_by({value(kTurnX), value(kTurnY), value(kTurnZ)}),
          .translation = {-std::cos(up) * std::cos(forward), -std::sin(up) * std::cos(forward),
                          -std::sin(forward)}};
}

RigModel::Parameters RigModel::with_pose(const Eigen::Matrix3d& rotation,
                                         const Eigen::Vector3d& translation) {
  const Eigen::Vector3d turn = rotation_vector(rotation);
  Parameters parameters = usual();
  for (int axis = 0; axis < 3; ++axis) {
    parameters[kTurnX + axis] = turn[axis] / kUsual[kTurnX];
  }
  const Eigen::Vector3d direction = translation.normalized() * (translation.x() > 0 ? -1.0 : 1.0);
  parameters[kBaselineUp] = std::atan2(-direction.y(), -direction.x()) / kUsual[kBaselineUp];
  parameters[kBaselineForward] = std::asin(-direction.z()) / kUsual[kBaselineForward];
  return parameters;
}

StereoCalibration RigModel::calibration(const Parameters& parameters) const {
  const Cameras rig = cameras(parameters);
  const double sign = rig.rotation.row(0).dot(rig.translation.transpose()) > 0 ? -1 : 1;
  return {.left = rig.left.camera(),
          .right = rig.right.camera(),
          .rotation = rig.rotation,
          .translation = sign * rig.translation,
          .image_size = ImageSize{static_cast<int>(width_px_), static_cast<int>(height_px_)},
          .is_rectified = false,
          .format = "estimate from the images"};
}

Eigen::VectorXd RigModel::epipolar_distances(const Parameters& parameters,
                                             const std::vector<PointMatch>& matches) const {
  const Cameras rig = cameras(parameters);
  const Eigen::Matrix3d essential = cross_matrix(rig.translation) * rig.rotation;
  Eigen::VectorXd distances(static_cast<Eigen::Index>(matches.size()));
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    const PointMatch& match = matches[static_cast<std::size_t>(i)];
    const IdealPosition left = rig.left.ideal(match.left);
    const IdealPosition right = rig.right.ideal(match.right);
    const Eigen::Vector3d right_line = essential * left.ray;
    const Eigen::Vector3d left_line = essential.transpose() * right.ray;
    // Lines in pixels of ideal images, then scaled to the photographs.
    const double gradient =
        std::hypot(right_line.head<2>().norm() / (rig.right.focal_px * right.magnification),
                   left_line.head<2>().norm() / (rig.left.focal_px * left.magnification));
    distances[i] = right.ray.dot(right_line) / std::max(gradient, 1e-12);
  }
  return distances;
}

Eigen::VectorXd RigModel::turning_distances(const Parameters& parameters,
                                            const std::vector<PointMatch>& matches) const {
  constexpr double kFar_px = 1e4;
  const Cameras rig = cameras(parameters);
  Eigen::VectorXd distances(2 * static_cast<Eigen::Index>(matches.size()));
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector3d ray = rig.rotation * rig.left.ideal(matches[i].left).ray;
    distances.segment<2>(2 * static_cast<Eigen::Index>(i)) =
        ray.z() > 0.05 ? Eigen::Vector2d(rig.right.position(ray) - matches[i].right)
                       : Eigen::Vector2d::Constant(kFar_px);
  }
  return distances;
}

RigModel::Parameters RigModel::least_squares(const Parameters& start, Eigen::Index residuals,
                                             const Residuals& of) {
  Problem problem{of, residuals};
  Eigen::LevenbergMarquardt<Problem, double> minimiser(problem);
  minimiser.parameters.maxfev = 100;
  minimiser.parameters.xtol = 1e-12;
  minimiser.parameters.ftol = 1e-14;
  Eigen::VectorXd parameters = start;
  minimiser.minimize(parameters);
  return parameters.allFinite() ? Parameters(parameters) : start;
}

RigModel::Parameters RigModel::fit(const Parameters& start, const std::vector<PointMatch>& matches,
                                   const Eigen::VectorXd& weights, double deviation_px) const {
  const Eigen::VectorXd factors = weights.cwiseSqrt() / deviation_px;
  return least_squares(start, factors.size(), [&](const Parameters& parameters) {
    return Eigen::VectorXd(epipolar_distances(parameters, matches).cwiseProduct(factors));
  });
}

RigModel::Parameters RigModel::fit_turning(const Parameters& start,
                                           const std::vector<PointMatch>& matches,
                                           const Eigen::VectorXd& weights,
                                           double deviation_px) const {
  const Eigen::VectorXd factors = weights.cwiseSqrt() / deviation_px;
  return least_squares(start, 2 * factors.size(), [&](const Parameters& parameters) {
    Eigen::VectorXd distances = turning_distances(parameters, matches);
    for (Eigen::Index i = 0; i < factors.size(); ++i) {
      distances.segment<2>(2 * i) *= factors[i];
    }
    return distances;
  });
}

}  // namespace vantage
