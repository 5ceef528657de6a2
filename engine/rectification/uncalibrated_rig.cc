#include "engine/rectification/uncalibrated_rig.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

#include "engine/error.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/order_statistics.h"
#include "engine/rectification/rig_model.h"
#include "engine/rectification/vertical_error.h"

namespace vantage {
namespace {

constexpr std::size_t kMaxMatches = 3000;
constexpr double kMinInlierShare = 0.3;
constexpr double kRigDeviations = 4.5;
constexpr double kMinParallax_px = 0.5;
/// Matches below this distance count as exact.
constexpr double kExact_px = 1e-3;
/// Residual lens errors of neighbouring matches are correlated, so more matches add little
/// information: they count as at most this many independent ones, and as a ninth of their number.
constexpr double kMostIndependent = 50;
constexpr double kAlike = 9;
/// For a longer side of 640 pixels: lens curvature, and the error of wrong positions.
constexpr double kTolerancePerSide = 2.0 / 640;

std::vector<PointMatch> thinned(const std::vector<PointMatch>& matches) {
  const std::size_t step = (matches.size() + kMaxMatches - 1) / kMaxMatches;
  std::vector<PointMatch> kept;
  for (std::size_t i = 0; i < matches.size(); i += step) {
    kept.push_back(matches[i]);
  }
  return kept;
}

struct RobustFundamental {
  Eigen::Matrix3d matrix;
  Eigen::VectorXd weights;  ///< 1: near it, 0: not
};

RobustFundamental robust_fundamental(const std::vector<PointMatch>& matches, double tolerance_px) {
  prepare_opencv();
  std::vector<cv::Point2d> left;
  std::vector<cv::Point2d> right;
  for (const PointMatch& match : matches) {
    left.emplace_back(match.left.x(), match.left.y());
    right.emplace_back(match.right.x(), match.right.y());
  }
  cv::Mat matrix;
  std::vector<std::uint8_t> is_near;
  try {
    matrix =
        cv::findFundamentalMat(left, right, cv::USAC_MAGSAC, tolerance_px, 0.9999, 10000, is_near);
  } catch (const cv::Exception&) {
    matrix.release();  // USAC also gives up this way when no sample is plausible
  }
  RobustFundamental result;
  result.matrix.setZero();
  result.weights.setZero(static_cast<Eigen::Index>(matches.size()));
  if (matrix.rows != 3 || matrix.cols != 3 || is_near.size() != matches.size()) {
    return result;
  }
  cv::cv2eigen(matrix, result.matrix);
  for (std::size_t i = 0; i < is_near.size(); ++i) {
    result.weights[static_cast<Eigen::Index>(i)] = is_near[i] != 0 ? 1 : 0;
  }
  return result;
}

/// The pose of the fundamental matrix for usual lenses; of the two solutions, the one with less
/// rotation.
RigModel::Parameters pose_of(const Eigen::Matrix3d& fundamental, const RigModel& model) {
  const StereoCalibration usual = model.calibration(RigModel::usual());
  const Eigen::Matrix3d essential =
      usual.right.matrix.transpose() * fundamental * usual.left.matrix;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(essential, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d quarter_turn;
  quarter_turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Eigen::Matrix3d first = svd.matrixU() * quarter_turn * svd.matrixV().transpose();
  Eigen::Matrix3d second = svd.matrixU() * quarter_turn.transpose() * svd.matrixV().transpose();
  first *= first.determinant() < 0 ? -1 : 1;
  second *= second.determinant() < 0 ? -1 : 1;
  return RigModel::with_pose(first.trace() > second.trace() ? first : second, svd.matrixU().col(2));
}

/// Parameters and the matches that agree with them.
struct Fit {
  RigModel::Parameters parameters;
  Eigen::VectorXd weights;
  double deviation_px = 0;

  [[nodiscard]] int inliers() const { return static_cast<int>((weights.array() > 0).count()); }
};

/// Factor by which deviations are raised for correlated matches.
double alike(int matches) { return std::sqrt(std::max(kAlike, matches / kMostIndependent)); }

/// Alternates between fitting and reselecting the matches and their deviation.
Fit epipolar_fit(const RigModel& model, const std::vector<PointMatch>& matches, Fit fit,
                 double tolerance_px) {
  constexpr int kMaxRounds = 40;
  constexpr int kPatientRounds = 5;
  for (int round = 0; round < kMaxRounds && fit.inliers() >= kMinMatches; ++round) {
    fit.parameters =
        model.fit(fit.parameters, matches, fit.weights, alike(fit.inliers()) * fit.deviation_px);
    const Eigen::VectorXd distances = model.epipolar_distances(fit.parameters, matches);
    std::vector<double> near;
    for (Eigen::Index i = 0; i < distances.size(); ++i) {
      if (fit.weights[i] > 0) {
        near.push_back(std::abs(distances[i]));
      }
    }
    const double deviation_px = std::max(1.4826 * upper_median(near), 1e-9);
    // As long as the cameras move away from the usual ones, exact matches may be far off.
    const double patience_px =
        std::max(std::ldexp(tolerance_px, 3 * std::min(kPatientRounds - round, 0)), kExact_px);
    // Larger deviations do not agree, however many there are.
    const double max_px = round < kPatientRounds ? HUGE_VAL : 2 * tolerance_px;
    const double limit_px = std::min(std::max(kRigDeviations * deviation_px, patience_px), max_px);
    const Eigen::ArrayXd share = (distances.array() / limit_px).square();
    fit.weights = (share < 1).select((1 - share).square(), 0);
    const double change = std::abs(deviation_px - fit.deviation_px);
    fit.deviation_px = deviation_px;
    if (round >= kPatientRounds && change <= 1e-3 * deviation_px &&
        (limit_px != patience_px || patience_px == kExact_px)) {
      break;
    }
  }
  return fit;
}

/// Cost of a fit: unexplained matches, plus a little for poorly explained ones and for unusual
/// cameras.
double cost_of(const Fit& fit, const RigModel& model, const std::vector<PointMatch>& matches,
               double tolerance_px) {
  const Eigen::ArrayXd share =
      (model.epipolar_distances(fit.parameters, matches).array() / tolerance_px).square();
  return (share / (1 + share)).sum() + 0.05 * RigModel::surprise(fit.parameters);
}

/// 90th percentile of the matches' distance, in pixels, from the prediction of a usual lens that
/// only rotated. The fit starts at `start`.
double distance_from_turning_px(const RigModel& model, const std::vector<PointMatch>& matches,
                                const RigModel::Parameters& start, double tolerance_px) {
  constexpr int kRounds = 6;
  const auto count = static_cast<Eigen::Index>(matches.size());
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(count);
  RigModel::Parameters turned = start;
  std::vector<double> distances(matches.size());
  for (int round = 0; round < kRounds; ++round) {
    turned = model.fit_turning(turned, matches, weights, tolerance_px);
    const Eigen::VectorXd apart = model.turning_distances(turned, matches);
    for (Eigen::Index i = 0; i < count; ++i) {
      distances[static_cast<std::size_t>(i)] = apart.segment<2>(2 * i).norm();
    }
    // Under pure rotation, wrong matches may lie on an epipolar line by chance.
    const double limit_px = std::max(6 * upper_median(std::vector(distances)), kExact_px);
    for (Eigen::Index i = 0; i < count; ++i) {
      weights[i] = distances[static_cast<std::size_t>(i)] < limit_px ? 1 : 0;
    }
  }
  return value_of_rank(distances, distances.size() * 9 / 10);
}

void require_parallax(const RigModel& model, const std::vector<PointMatch>& matches, const Fit& fit,
                      double tolerance_px) {
  std::vector<PointMatch> inliers;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (fit.weights[static_cast<Eigen::Index>(i)] > 0) {
      inliers.push_back(matches[i]);
    }
  }
  const double min_px = std::max(kMinParallax_px, 4 * fit.deviation_px);
  for (const RigModel::Parameters& start : {RigModel::usual(), fit.parameters}) {
    const double parallax_px = distance_from_turning_px(model, inliers, start, tolerance_px);
    if (!(parallax_px >= min_px)) {
      throw Error(
          fmt::format("the parallax is at most {:.2f} pixels, as if the camera had only turned, "
                      "expected at least {:.2f}",
                      parallax_px, min_px));
    }
  }
}

void require_sideways_move(const StereoCalibration& calibration, int width_px, int height_px) {
  const Eigen::Vector3d right_centre = -calibration.rotation.transpose() * calibration.translation;
  if (std::abs(right_centre.z()) <= 1e-9) {
    return;
  }
  const Eigen::Vector2d epipole = (calibration.left.matrix * right_centre).hnormalized();
  if (epipole.x() > -0.5 && epipole.x() < width_px - 0.5 && epipole.y() > -0.5 &&
      epipole.y() < height_px - 0.5) {
    throw Error(
        fmt::format("the epipole lies inside the left image, at ({:.0f}, {:.0f}): the camera moved "
                    "forward or backward, expected a move to the side",
                    epipole.x(), epipole.y()));
  }
}

void require_enough(int inliers, std::size_t matches) {
  if (inliers < kMinMatches || inliers < kMinInlierShare * static_cast<double>(matches)) {
    throw Error(
        fmt::format("{} of {} common points agree with one rig, expected at least {} and {} %",
                    inliers, matches, kMinMatches, 100 * kMinInlierShare));
  }
}

}  // namespace

UncalibratedRig estimate_rig(const std::vector<PointMatch>& matches, int width_px, int height_px) {
  if (width_px < 2 || height_px < 2) {
    throw Error(fmt::format("the images are {}x{}, expected at least 2x2", width_px, height_px));
  }
  if (static_cast<int>(matches.size()) < kMinMatches) {
    throw Error(fmt::format("the images have {} points in common, expected at least {}",
                            matches.size(), kMinMatches));
  }
  const std::vector<PointMatch> used = thinned(matches);
  const RigModel model(width_px, height_px);
  const double tolerance_px = kTolerancePerSide * std::max(width_px, height_px);
  const RobustFundamental fundamental = robust_fundamental(used, tolerance_px);

  const Eigen::VectorXd all = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(used.size()));
  std::vector<Fit> starts = {{RigModel::usual(), all, tolerance_px}};
  if (!fundamental.matrix.isZero(0)) {
    starts.push_back({RigModel::usual(), fundamental.weights, tolerance_px});
    // Close enough to the truth to weigh the prior less.
    starts.push_back({pose_of(fundamental.matrix, model), fundamental.weights, tolerance_px / 8});
  }
  Fit best;
  double min_cost = 0;
  for (const Fit& start : starts) {
    const Fit fit = epipolar_fit(model, used, start, tolerance_px);
    const double cost = cost_of(fit, model, used, tolerance_px / 2);
    if (best.weights.size() == 0 || cost < min_cost) {
      best = fit;
      min_cost = cost;
    }
  }
  require_enough(best.inliers(), used.size());
  UncalibratedRig rig{.calibration = model.calibration(best.parameters)};
  rig.calibration.has_scale = false;
  require_parallax(model, used, best, tolerance_px);
  require_sideways_move(rig.calibration, width_px, height_px);

  const double limit_px = std::max(kRigDeviations * best.deviation_px, kExact_px);
  double sum_of_squares = 0;
  for (const double distance : model.epipolar_distances(best.parameters, matches)) {
    rig.is_inlier.push_back(std::abs(distance) <= limit_px);
    if (rig.is_inlier.back()) {
      ++rig.inliers;
      sum_of_squares += distance * distance;
    }
  }
  rig.rms_px = std::sqrt(sum_of_squares / rig.inliers);
  return rig;
}

}  // namespace vantage
