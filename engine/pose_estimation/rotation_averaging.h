#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace vantage {

/// x_second = rotation · x_first, up to the translation.
struct RelativeRotation {
  int first = 0;
  int second = 0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double weight = 1;  ///< above 0
};

/// Rotations of cameras that relative ones of pairs agree with.
struct AveragedRotations {
  /// x_camera = rotation · x_world; the identity for the lowest camera of the joined ones.
  std::vector<Eigen::Matrix3d> rotations;
  std::vector<bool> is_joined;      ///< the largest group of cameras that pairs join
  std::vector<double> off_degrees;  ///< of each pair from the result; 180 outside the group
};

/// Rotations of `cameras` cameras that the pairs agree with best: of the strongest tree of pairs,
/// then the weighted median (iteratively reweighted least squares), so that single wrong pairs
/// have no effect where others contradict them. Pairs that are more than `max_degrees` off do not
/// join cameras. Thread rule: pure.
AveragedRotations average_rotations(int cameras, std::span<const RelativeRotation> pairs,
                                    double max_degrees);

}  // namespace vantage
