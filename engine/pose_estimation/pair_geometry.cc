#include "engine/pose_estimation/pair_geometry.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "engine/io/images/opencv_setup.h"

namespace vantage {
namespace {

constexpr double kPairTolerance_px = 2;
constexpr double kMinPairShare = 0.3;
constexpr double kSamplingConfidence = 0.9999;

struct PointLists {
  std::vector<cv::Point2d> left;
  std::vector<cv::Point2d> right;
};

PointLists scaled_points(std::span<const PointMatch> matches, double scale) {
  PointLists lists;
  for (const PointMatch& match : matches) {
    lists.left.emplace_back(match.left.x() * scale, match.left.y() * scale);
    lists.right.emplace_back(match.right.x() * scale, match.right.y() * scale);
  }
  return lists;
}

Eigen::Matrix3d matrix_of(const cv::Mat& matrix) {
  Eigen::Matrix3d result;
  cv::cv2eigen(matrix, result);
  return result;
}

/// Inliers that are ahead of both cameras, however far.
int count_ahead(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& shift,
                std::span<const PointMatch> matches, const std::vector<std::uint8_t>& is_inlier,
                double focal_px) {
  int count = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector3d first = rotation * (matches[i].left / focal_px).homogeneous();
    const Eigen::Vector3d second = (matches[i].right / focal_px).homogeneous();
    // depth_second · second = depth_first · first + shift, times the square of |second × first|.
    const Eigen::Vector3d normal = second.cross(first);
    const double depth_first = -second.cross(shift).dot(normal);
    const double depth_second = -first.cross(shift).dot(normal);
    count += is_inlier[i] != 0 && depth_first > 0 && depth_second > 0 ? 1 : 0;
  }
  return count;
}

}  // namespace

std::optional<PairGeometry> pair_geometry(std::span<const PointMatch> matches,
                                          std::span<const std::array<int, 2>> features,
                                          double focal_px) {
  if (static_cast<int>(matches.size()) < kMinPairInliers) {
    return std::nullopt;
  }
  prepare_opencv();
  const PointLists rays = scaled_points(matches, 1 / focal_px);
  std::vector<std::uint8_t> is_inlier;
  std::array<cv::Mat, 2> rotations;
  cv::Mat translation;
  try {
    const cv::Mat essential =
        cv::findEssentialMat(rays.left, rays.right, cv::Mat::eye(3, 3, CV_64F), cv::USAC_MAGSAC,
                             kSamplingConfidence, kPairTolerance_px / focal_px, is_inlier);
    if (essential.rows != 3 || essential.cols != 3) {
      return std::nullopt;
    }
    cv::decomposeEssentialMat(essential, rotations[0], rotations[1], translation);
  } catch (const cv::Exception&) {
    return std::nullopt;  // no sample is plausible
  }
  PairGeometry pair;
  pair.matches = static_cast<int>(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (is_inlier[i] != 0) {
      pair.inliers.push_back(features[i]);
    }
  }
  if (static_cast<int>(pair.inliers.size()) < kMinPairInliers ||
      static_cast<double>(pair.inliers.size()) < kMinPairShare * pair.matches) {
    return std::nullopt;
  }
  Eigen::Vector3d shift;
  cv::cv2eigen(translation, shift);
  int most_ahead = -1;
  for (const cv::Mat& one : rotations) {
    const Eigen::Matrix3d rotation = matrix_of(one);
    for (const double sign : {1.0, -1.0}) {
      const int ahead = count_ahead(rotation, sign * shift, matches, is_inlier, focal_px);
      if (ahead > most_ahead) {
        most_ahead = ahead;
        pair.rotation = rotation;
        pair.direction = sign * shift;
      }
    }
  }
  return pair;
}

std::vector<double> focal_disagreements(std::span<const PointMatch> matches,
                                        std::span<const double> focal_lengths_px) {
  if (static_cast<int>(matches.size()) < kMinPairInliers) {
    return {};
  }
  prepare_opencv();
  const PointLists points = scaled_points(matches, 1);
  cv::Mat fundamental;
  try {
    fundamental = cv::findFundamentalMat(points.left, points.right, cv::USAC_MAGSAC,
                                         kPairTolerance_px, kSamplingConfidence);
  } catch (const cv::Exception&) {
    return {};
  }
  if (fundamental.rows != 3 || fundamental.cols != 3) {
    return {};
  }
  const Eigen::Matrix3d of_pixels = matrix_of(fundamental);
  std::vector<double> disagreements;
  for (const double focal_px : focal_lengths_px) {
    const Eigen::Vector3d scale(focal_px, focal_px, 1);
    const Eigen::Matrix3d essential = scale.asDiagonal() * of_pixels * scale.asDiagonal();
    const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::Matrix3d>(essential).singularValues();
    disagreements.push_back((values[0] - values[1]) / (values[0] + values[1]));
  }
  return disagreements;
}

}  // namespace vantage
