#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/pose_estimation/feature_tracks.h"

namespace vantage {

/// A camera of a bundle: x_camera = rotation · (x_world − centre).
struct BundleCamera {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

/// The lens of all cameras: position = focal_px · (1 + k1 |ray|²) · ray, from the principal point.
struct BundleLens {
  double focal_px = 1;
  double k1 = 0;
};

/// Cameras of one lens and the points that they see; the gauge is free.
struct Bundle {
  std::vector<BundleCamera> cameras;
  BundleLens lens;
  std::vector<PointTrack> tracks;

  /// Where a camera sees a point of the world, from the principal point; infinite if it is not
  /// ahead.
  [[nodiscard]] Eigen::Vector2d projection_px(int image, const Eigen::Vector3d& point) const;
  /// Distances of all sightings from the projections of their points, track after track.
  [[nodiscard]] std::vector<double> errors_px() const;
};

/// Root of the mean square of errors; infinite ones do not count. 0 for none.
double rms_of(const std::vector<double>& errors_px);

/// Moves cameras and points, and with `fits_lens` the lens, to where the sum over all sightings of
/// s² log(1 + (error / s)²) is smallest, s = `outlier_px`: Levenberg–Marquardt with the points
/// eliminated (Schur complement), weights renewed in each step. Sightings whose point is not ahead
/// do not count. Deterministic. Thread rule: may be called concurrently.
void adjust_bundle(Bundle& bundle, double outlier_px, bool fits_lens);

}  // namespace vantage
