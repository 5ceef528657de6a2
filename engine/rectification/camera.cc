#include "engine/rectification/camera.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "engine/error.h"

namespace vantage {
namespace {

// tan 80°: a plane cannot show much more.
constexpr double kLargestRay = 5.67;
// Step of the radius in the search for the fold of the polynomial.
constexpr double kRayStep = 1.0 / 512;

enum Coefficient { kK1, kK2, kP1, kP2, kK3, kK4, kK5, kK6, kS1, kS2, kS3, kS4, kTauX, kTauY };

std::array<double, 14> all_coefficients(const Camera& camera) {
  std::array<double, 14> coefficients{};
  std::copy(camera.distortion.begin(), camera.distortion.end(), coefficients.begin());
  return coefficients;
}

/// Rotation of the sensor by τx about its x axis, then by τy about its y axis, and the projection
/// from the lens' image plane onto it.
Eigen::Matrix3d tilt_projection(double tau_x, double tau_y) {
  Eigen::Matrix3d about_x;
  about_x << 1, 0, 0, 0, std::cos(tau_x), std::sin(tau_x), 0, -std::sin(tau_x), std::cos(tau_x);
  Eigen::Matrix3d about_y;
  about_y << std::cos(tau_y), 0, -std::sin(tau_y), 0, 1, 0, std::sin(tau_y), 0, std::cos(tau_y);
  const Eigen::Matrix3d turn = about_y * about_x;
  Eigen::Matrix3d onto_sensor;
  onto_sensor << turn(2, 2), 0, -turn(0, 2), 0, turn(2, 2), -turn(1, 2), 0, 0, 1;
  return onto_sensor * turn;
}

/// Numerator and denominator of the radial scale of a ray of squared length r2.
struct RadialFactor {
  double numerator;
  double denominator;
};

RadialFactor radial_factor(const std::array<double, 14>& k, double r2) {
  return {1 + r2 * (k[kK1] + r2 * (k[kK2] + r2 * k[kK3])),
          1 + r2 * (k[kK4] + r2 * (k[kK5] + r2 * k[kK6]))};
}

/// Distance from the centre, for a focal length of 1, of a ray at `angle` from the axis.
double fisheye_radius(const std::array<double, 14>& k, double angle) {
  const double square = angle * angle;
  return angle * (1 + square * (k[0] + square * (k[1] + square * (k[2] + square * k[3]))));
}

double growing_up_to(const std::array<double, 14>& k, LensKind kind) {
  double distorted_radius = 0;
  for (double r = kRayStep; r <= kLargestRay; r += kRayStep) {
    const RadialFactor factor = kind == LensKind::kFisheye
                                    ? RadialFactor{fisheye_radius(k, std::atan(r)) / r, 1}
                                    : radial_factor(k, r * r);
    const double next = r * factor.numerator / factor.denominator;
    if (!(factor.denominator > 0) || !(next > distorted_radius)) {
      return r - kRayStep;
    }
    distorted_radius = next;
  }
  return kLargestRay;
}

}  // namespace

bool Camera::is_without_distortion() const {
  return lens == LensKind::kStandard &&
         std::all_of(distortion.begin(), distortion.end(), [](double k) { return k == 0; });
}

void Camera::validate(const std::string& name) const {
  if (!matrix.allFinite()) {
    throw Error(fmt::format("the {}'s matrix has values that are not finite numbers", name));
  }
  for (const auto& [field, value] : {std::pair{"fx", matrix(0, 0)}, {"fy", matrix(1, 1)}}) {
    if (!(value >= 1e-3 && value <= 1e7)) {
      throw Error(fmt::format("the {}'s {} is {}, expected a focal length of 0.001 to 1e7 pixels",
                              name, field, value));
    }
  }
  if (matrix(1, 0) != 0 || matrix(2, 0) != 0 || matrix(2, 1) != 0 || matrix(2, 2) != 1) {
    throw Error(fmt::format("the {}'s matrix is not of the form fx s cx, 0 fy cy, 0 0 1", name));
  }
  const std::size_t count = distortion.size();
  if (lens == LensKind::kFisheye && count != 4) {
    throw Error(fmt::format(
        "the {} has {} distortion coefficients, expected the 4 of a fisheye lens", name, count));
  }
  if (count != 0 && count != 4 && count != 5 && count != 8 && count != 12 && count != 14) {
    throw Error(fmt::format("the {} has {} distortion coefficients, expected 0, 4, 5, 8, 12 or 14",
                            name, count));
  }
  for (const double coefficient : distortion) {
    if (!(std::abs(coefficient) <= 1e6)) {
      throw Error(fmt::format("the {} has the distortion coefficient {}, expected at most 1e6",
                              name, coefficient));
    }
  }
}

LensModel::LensModel(const Camera& camera)
    : matrix_(camera.matrix),
      inverse_matrix_(camera.matrix.inverse()),
      coefficients_(all_coefficients(camera)),
      kind_(camera.lens),
      tilt_(tilt_projection(coefficients_[kTauX], coefficients_[kTauY])),
      is_tilted_(coefficients_[kTauX] != 0 || coefficients_[kTauY] != 0),
      largest_ray_(growing_up_to(coefficients_, kind_)) {}

Eigen::Vector2d LensModel::distorted(const Eigen::Vector2d& ray) const {
  const auto& k = coefficients_;
  const double x = ray.x();
  const double y = ray.y();
  const double r2 = x * x + y * y;
  if (kind_ == LensKind::kFisheye) {
    const double r = std::sqrt(r2);
    return r > 0 ? Eigen::Vector2d(ray * (fisheye_radius(k, std::atan(r)) / r)) : ray;
  }
  const RadialFactor factor = radial_factor(k, r2);
  const double radial = factor.numerator / factor.denominator;
  const Eigen::Vector2d flat(
      x * radial + 2 * k[kP1] * x * y + k[kP2] * (r2 + 2 * x * x) + r2 * (k[kS1] + r2 * k[kS2]),
      y * radial + k[kP1] * (r2 + 2 * y * y) + 2 * k[kP2] * x * y + r2 * (k[kS3] + r2 * k[kS4]));
  return is_tilted_ ? (tilt_ * flat.homogeneous()).hnormalized() : flat;
}

Eigen::Vector2d LensModel::fisheye_ray(const Eigen::Vector2d& distorted) const {
  const double radius = distorted.norm();
  double below = 0;
  double above = std::atan(largest_ray_);
  for (int halving = 0; halving < 60; ++halving) {  // the radius grows with the angle up to there
    const double middle = (below + above) / 2;
    (fisheye_radius(coefficients_, middle) < radius ? below : above) = middle;
  }
  return radius > 0 ? Eigen::Vector2d(distorted * (std::tan(above) / radius)) : distorted;
}

std::optional<Eigen::Vector2d> LensModel::position_of(const Eigen::Vector2d& ray) const {
  if (!(ray.squaredNorm() <= largest_ray_ * largest_ray_)) {
    return std::nullopt;
  }
  return (matrix_ * distorted(ray).homogeneous()).head<2>();
}

std::optional<Eigen::Vector2d> LensModel::ray_of(const Eigen::Vector2d& position_px) const {
  constexpr int kMaxSteps = 60;
  constexpr double kDifference = 1e-6;
  constexpr double kPrecision = 1e-10;
  const Eigen::Vector2d wanted = (inverse_matrix_ * position_px.homogeneous()).head<2>();
  if (kind_ == LensKind::kFisheye) {
    const Eigen::Vector2d found = fisheye_ray(wanted);
    return (distorted(found) - wanted).norm() <= kPrecision ? std::optional(found) : std::nullopt;
  }
  Eigen::Vector2d ray = wanted;
  if (ray.norm() > largest_ray_) {
    ray *= 0.9 * largest_ray_ / ray.norm();
  }
  Eigen::Vector2d residual = distorted(ray) - wanted;
  for (int i = 0; i < kMaxSteps && residual.norm() > kPrecision; ++i) {
    Eigen::Matrix2d jacobian;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kDifference * Eigen::Vector2d::Unit(axis);
      jacobian.col(axis) = (distorted(ray + step) - distorted(ray - step)) / (2 * kDifference);
    }
    const Eigen::Vector2d full_step = -jacobian.inverse() * residual;
    // Halved until the step brings the ray closer without leaving the invertible part.
    double share = 1;
    for (; share > 1e-6; share /= 2) {
      const Eigen::Vector2d next = ray + share * full_step;
      const Eigen::Vector2d next_residual = distorted(next) - wanted;
      if (next.norm() <= largest_ray_ && next_residual.norm() < residual.norm()) {
        ray = next;
        residual = next_residual;
        break;
      }
    }
    if (share <= 1e-6) {
      break;
    }
  }
  return residual.norm() <= kPrecision ? std::optional(ray) : std::nullopt;
}

}  // namespace vantage
