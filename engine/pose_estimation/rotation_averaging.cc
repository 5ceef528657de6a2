#include "engine/pose_estimation/rotation_averaging.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "engine/rectification/rotations.h"

namespace vantage {
namespace {

constexpr double kDegreeOfTurn = std::numbers::pi / 180;

/// The cameras of the largest group that pairs join; of groups of one size the first.
std::vector<bool> largest_group(int cameras, std::span<const RelativeRotation> pairs,
                                const std::vector<bool>& counts) {
  std::vector<int> group(static_cast<std::size_t>(cameras));
  std::iota(group.begin(), group.end(), 0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const int first = group[static_cast<std::size_t>(pairs[i].first)];
    const int second = group[static_cast<std::size_t>(pairs[i].second)];
    if (counts[i] && first != second) {
      std::ranges::replace(group, std::max(first, second), std::min(first, second));
    }
  }
  int largest = 0;
  for (int number = 1; number < cameras; ++number) {
    if (std::ranges::count(group, number) > std::ranges::count(group, largest)) {
      largest = number;
    }
  }
  std::vector<bool> is_joined;
  for (const int number : group) {
    is_joined.push_back(number == largest);
  }
  return is_joined;
}

/// Rotations along the tree of the heaviest pairs, from the lowest joined camera.
std::vector<Eigen::Matrix3d> tree_rotations(int cameras, std::span<const RelativeRotation> pairs,
                                            const std::vector<bool>& counts,
                                            const std::vector<bool>& is_joined) {
  std::vector<Eigen::Matrix3d> rotations(static_cast<std::size_t>(cameras),
                                         Eigen::Matrix3d::Identity());
  std::vector<bool> is_known(static_cast<std::size_t>(cameras), false);
  is_known[static_cast<std::size_t>(std::ranges::find(is_joined, true) - is_joined.begin())] = true;
  while (true) {
    const RelativeRotation* best = nullptr;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const RelativeRotation& pair = pairs[i];
      if (counts[i] &&
          is_known[static_cast<std::size_t>(pair.first)] !=
              is_known[static_cast<std::size_t>(pair.second)] &&
          (best == nullptr || pair.weight > best->weight)) {
        best = &pair;
      }
    }
    if (best == nullptr) {
      return rotations;
    }
    const auto first = static_cast<std::size_t>(best->first);
    const auto second = static_cast<std::size_t>(best->second);
    if (is_known[first]) {
      rotations[second] = best->rotation * rotations[first];
    } else {
      rotations[first] = best->rotation.transpose() * rotations[second];
    }
    is_known[first] = is_known[second] = true;
  }
}

/// What is left of the turn of a pair, in the frame of its second camera.
Eigen::Vector3d residual_of(const RelativeRotation& pair,
                            const std::vector<Eigen::Matrix3d>& rotations) {
  return rotation_vector(pair.rotation * rotations[static_cast<std::size_t>(pair.first)] *
                         rotations[static_cast<std::size_t>(pair.second)].transpose());
}

void improve(std::span<const RelativeRotation> pairs, const std::vector<bool>& counts,
             const std::vector<bool>& is_joined, std::vector<Eigen::Matrix3d>& rotations) {
  constexpr int kSteps = 50;
  constexpr double kSmallestResidual = 0.05 * kDegreeOfTurn;
  const auto cameras = static_cast<Eigen::Index>(rotations.size());
  for (int step = 0; step < kSteps; ++step) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(3 * cameras, 3 * cameras);
    Eigen::VectorXd right_side = Eigen::VectorXd::Zero(3 * cameras);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const RelativeRotation& pair = pairs[i];
      if (!counts[i] || !is_joined[static_cast<std::size_t>(pair.first)]) {
        continue;
      }
      const Eigen::Vector3d residual = residual_of(pair, rotations);
      const double weight = pair.weight / std::max(residual.norm(), kSmallestResidual);
      // residual + rotation · turn of the first − turn of the second = 0
      const Eigen::Index first = 3 * pair.first;
      const Eigen::Index second = 3 * pair.second;
      normal.block<3, 3>(first, first).diagonal().array() += weight;
      normal.block<3, 3>(second, second).diagonal().array() += weight;
      normal.block<3, 3>(first, second) -= weight * pair.rotation.transpose();
      normal.block<3, 3>(second, first) -= weight * pair.rotation;
      right_side.segment<3>(first) -= weight * (pair.rotation.transpose() * residual);
      right_side.segment<3>(second) += weight * residual;
    }
    const auto fixed =
        static_cast<Eigen::Index>(std::ranges::find(is_joined, true) - is_joined.begin());
    for (Eigen::Index camera = 0; camera < cameras; ++camera) {
      if (camera == fixed || !is_joined[static_cast<std::size_t>(camera)]) {
        normal.middleRows<3>(3 * camera).setZero();
        normal.middleCols<3>(3 * camera).setZero();
        normal.block<3, 3>(3 * camera, 3 * camera).setIdentity();
        right_side.segment<3>(3 * camera).setZero();
      }
    }
    const Eigen::VectorXd turns = normal.ldlt().solve(right_side);
    for (Eigen::Index camera = 0; camera < cameras; ++camera) {
      Eigen::Matrix3d& rotation = rotations[static_cast<std::size_t>(camera)];
      rotation = rotation_by(turns.segment<3>(3 * camera)) * rotation;
    }
    if (turns.cwiseAbs().maxCoeff() < 1e-10) {
      break;
    }
  }
}

}  // namespace

AveragedRotations average_rotations(int cameras, std::span<const RelativeRotation> pairs,
                                    double max_degrees) {
  AveragedRotations result;
  std::vector<bool> counts(pairs.size(), true);
  // Pairs that contradict the others go, the worst first: each may have turned its neighbours.
  while (true) {
    result.is_joined = largest_group(cameras, pairs, counts);
    result.rotations = tree_rotations(cameras, pairs, counts, result.is_joined);
    improve(pairs, counts, result.is_joined, result.rotations);
    result.off_degrees.clear();
    double worst_degrees = max_degrees;
    std::size_t worst = pairs.size();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const bool is_inside = result.is_joined[static_cast<std::size_t>(pairs[i].first)] &&
                             result.is_joined[static_cast<std::size_t>(pairs[i].second)];
      result.off_degrees.push_back(
          is_inside ? residual_of(pairs[i], result.rotations).norm() / kDegreeOfTurn : 180);
      if (counts[i] && is_inside && result.off_degrees[i] > worst_degrees) {
        worst_degrees = result.off_degrees[i];
        worst = i;
      }
    }
    if (worst == pairs.size()) {
      return result;
    }
    counts[worst] = false;
  }
}

}  // namespace vantage
