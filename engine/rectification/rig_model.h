#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "engine/rectification/feature_matches.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// Two uncalibrated cameras with images of one size, described by few parameters with prior
/// distributions: parameters that the point matches do not determine, and a single pair leaves
/// many, stay near their usual values. Such cameras rectify by homographies that rotate the images
/// and hardly stretch them (Fusiello and Irsara, Quasi-Euclidean epipolar rectification, 2011, with
/// the lens added). Thread rule: may be used concurrently.
class RigModel {
 public:
  static constexpr int kParameters = 13;
  using Parameters = Eigen::Matrix<double, kParameters, 1>;
  using Residuals = std::function<Eigen::VectorXd(const Parameters&)>;

  /// `width_px` and `height_px` ≥ 2.
  RigModel(int width_px, int height_px);

  /// Parallel cameras side by side, with usual lenses.
  [[nodiscard]] static Parameters usual() { return Parameters::Zero(); }
  /// Usual lenses; x_right = rotation · x_left + translation. The translation's length and sign do
  /// not matter.
  [[nodiscard]] static Parameters with_pose(const Eigen::Matrix3d& rotation,
                                            const Eigen::Vector3d& translation);

  /// The cameras. The baseline has length 1, and the right camera is in the positive x direction:
  /// images alone do not determine scale, and hardly which camera is the left one. One distortion
  /// coefficient, k4.
  [[nodiscard]] StereoCalibration calibration(const Parameters& parameters) const;

  /// Signed distance of every match from the epipolar geometry, in pixels of the photographs
  /// (Sampson's approximation).
  [[nodiscard]] Eigen::VectorXd epipolar_distances(const Parameters& parameters,
                                                   const std::vector<PointMatch>& matches) const;
  /// Distance, in pixels, of every right position from its prediction by a pure rotation of the
  /// camera.
  [[nodiscard]] Eigen::VectorXd turning_distances(const Parameters& parameters,
                                                  const std::vector<PointMatch>& matches) const;

  /// The most likely parameters (Levenberg–Marquardt from `start`) given matches with this standard
  /// deviation of the distances, each weighted by `weights`.
  [[nodiscard]] Parameters fit(const Parameters& start, const std::vector<PointMatch>& matches,
                               const Eigen::VectorXd& weights, double deviation_px) const;
  /// As fit() on turning_distances(): the most likely camera under pure rotation.
  [[nodiscard]] Parameters fit_turning(const Parameters& start,
                                       const std::vector<PointMatch>& matches,
                                       const Eigen::VectorXd& weights, double deviation_px) const;

  /// Negative logarithm of the prior probability of the parameters.
  [[nodiscard]] static double surprise(const Parameters& parameters) {
    return parameters.squaredNorm() / 2;
  }

 private:
  struct Cameras;

  [[nodiscard]] Cameras cameras(const Parameters& parameters) const;
  [[nodiscard]] static Parameters least_squares(const Parameters& start, Eigen::Index residuals,
                                                const Residuals& of);

  double width_px_;
  double height_px_;
};

}  // namespace vantage
