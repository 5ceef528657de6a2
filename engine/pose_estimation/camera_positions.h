#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/pose_estimation/feature_tracks.h"

namespace vantage {

/// Positions of cameras of known rotations, up to a shift and a scale, and the points of tracks:
/// what makes all rays of each track meet best, with angles weighted alike at every depth
/// (iteratively reweighted; each step is the eigenvector of a matrix from which the points are
/// eliminated). Points with three sightings carry the scale from pair to pair.
///
/// `rotations`: x_camera = rotation · (x_world − centre). Sets the points of `tracks`, and removes
/// those whose rays are nearly parallel. Throws Error if the cameras have no parallax.
/// Thread rule: pure.
std::vector<Eigen::Vector3d> camera_positions(const std::vector<Eigen::Matrix3d>& rotations,
                                              double focal_px, std::vector<PointTrack>& tracks);

}  // namespace vantage
