#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "engine/rectification/feature_matches.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// Two cameras about which nothing is known but their images of one size, described by few numbers
/// of which is known what they usually are: what point matches leave open, and a single pair
/// leaves much open, stays usual. Such cameras rectify with homographies that turn the images and
/// hardly stretch them (Fusiello and Irsara, Quasi-Euclidean epipolar rectification, 2011, with the
/// lens added).
/// Thread rule: may be used concurrently.
class RigModel {
 public:
  static constexpr int kParameters = 13;
  using Parameters = Eigen::Matrix<double, kParameters, 1>;
  using Residuals = std::function<Eigen::VectorXd(const Parameters&)>;

  /// `width_px` and `height_px` ≥ 2.
  RigModel(int width_px, int height_px);

  /// Cameras side by side that look into the same direction, with usual lenses.
  [[nodiscard]] static Parameters usual() { return Parameters::Zero(); }
  /// Usual lenses; x_right = rotation · x_left + translation. The translation's length and sign do
  /// not matter.
  [[nodiscard]] static Parameters with_pose(const Eigen::Matrix3d& rotation,
                                            const Eigen::Vector3d& translation);

  /// The cameras. The baseline is 1 long, and the right camera stands in the positive x direction:
  /// images alone do not tell scale, and hardly which camera is the left one. One coefficient of
  /// distortion, k4.
  [[nodiscard]] StereoCalibration calibration(const Parameters& parameters) const;

  /// Distance of every match from agreeing with the epipolar geometry, in pixels of the photographs
  /// (Sampson's approximation), with a sign.
  [[nodiscard]] Eigen::VectorXd epipolar_distances(const Parameters& parameters,
                                                   const std::vector<PointMatch>& matches) const;
  /// Distance, in pixels, of every right position from where it would be if the camera had only
  /// turned.
  [[nodiscard]] Eigen::VectorXd turning_distances(const Parameters& parameters,
                                                  const std::vector<PointMatch>& matches) const;

  /// The likeliest parameters (Levenberg–Marquardt from `start`) given matches whose distances have
  /// this standard deviation, each counted `weights` times.
  [[nodiscard]] Parameters fit(const Parameters& start, const std::vector<PointMatch>& matches,
                               const Eigen::VectorXd& weights, double deviation_px) const;
  /// The same of turning_distances(): the likeliest camera that only turned.
  [[nodiscard]] Parameters fit_turning(const Parameters& start,
                                       const std::vector<PointMatch>& matches,
                                       const Eigen::VectorXd& weights, double deviation_px) const;

  /// Minus the logarithm of how likely the parameters are before any match is seen.
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
