#include "engine/rectification/vertical_error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/order_statistics.h"

namespace vantage {
namespace {

constexpr double kTolerance_px = 1;
constexpr double kErrorDeviations = 4;
/// Points at infinity have disparities around 0.
constexpr double kNegative_px = -0.5;
constexpr int kTerms = 7;
using Terms = Eigen::Matrix<double, Eigen::Dynamic, kTerms>;

/// Terms of the error per match: 1, x, y, d, x², xy, y², each normalised to −1..1.
Terms terms_of(const std::vector<PointMatch>& matches) {
  const auto count = static_cast<Eigen::Index>(matches.size());
  Eigen::ArrayX3d values(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PointMatch& match = matches[static_cast<std::size_t>(i)];
    values.row(i) << match.left.x(), match.left.y(), match.left.x() - match.right.x();
  }
  for (Eigen::Index column = 0; column < 3; ++column) {
    const double min = values.col(column).minCoeff();
    const double half_range = std::max((values.col(column).maxCoeff() - min) / 2, 1e-9);
    values.col(column) = (values.col(column) - min) / half_range - 1;
  }
  const auto x = values.col(0);
  const auto y = values.col(1);
  Terms terms(count, kTerms);
  terms << Eigen::ArrayXd::Ones(count), x, y, values.col(2), x * x, x * y, y * y;
  return terms;
}

/// The smooth part of `errors` at every match, by least squares with weights that decrease with the
/// distance from the previous fit; starts at the median, then adds terms.
Eigen::VectorXd smooth_part(const Terms& terms, const Eigen::VectorXd& errors) {
  constexpr int kRounds = 12;
  constexpr std::array<int, 3> kTermsOfDegree = {1, 4, kTerms};
  Eigen::VectorXd smooth = Eigen::VectorXd::Constant(
      errors.size(), upper_median(std::vector<double>(errors.begin(), errors.end())));
  for (const int count : kTermsOfDegree) {
    for (int round = 0; round < kRounds; ++round) {
      const Eigen::ArrayXd residuals = errors - smooth;
      std::vector<double> distances(static_cast<std::size_t>(residuals.size()));
      std::transform(residuals.begin(), residuals.end(), distances.begin(),
                     [](double residual) { return std::abs(residual); });
      const double deviation = std::max(1.4826 * upper_median(distances), 1e-6);
      // Tukey's weights: zero beyond six deviations.
      const Eigen::ArrayXd share = (residuals / (6 * deviation)).square();
      const Eigen::ArrayXd weights = (share < 1).select((1 - share).square(), 0);
      const auto used = terms.leftCols(count);
      const Eigen::MatrixXd normal = used.transpose() * weights.matrix().asDiagonal() * used +
                                     1e-9 * weights.sum() * Eigen::MatrixXd::Identity(count, count);
      const Eigen::VectorXd right = used.transpose() * (weights * errors.array()).matrix();
      smooth = used * normal.ldlt().solve(right);
    }
  }
  return smooth;
}

/// Additional bad pixels (wrong by more than 1 px) of preset balanced, in percentage points, if the
/// right photograph is shifted down by this much; mean over cones, motorcycle, art, aloe, venus,
/// baby1 and two of KITTI.
///
/// A share measured on the pair itself was tried: two bands of 48 rows, matched with and without
/// the shift, take about 7 ms, but pixels that fail the cross-check do not tell. For a shift of
/// 0.5, 1 and 2 px venus has 3, 13 and 21 points more of them, and 4, 31 and 67 points more bad
/// pixels; tsukuba has 1, 5 and 16 points more of both. Both maps agree on the same wrong
/// disparities.
constexpr std::array<std::pair<double, double>, 9> kMeasured = {{{0, 0},
                                                                 {0.125, 0.6},
                                                                 {0.25, 1.7},
                                                                 {0.375, 3.5},
                                                                 {0.5, 6.4},
                                                                 {0.75, 15},
                                                                 {1, 23},
                                                                 {1.5, 42},
                                                                 {2, 55}}};

}  // namespace

std::optional<VerticalError> vertical_error(const std::vector<PointMatch>& matches) {
  if (static_cast<int>(matches.size()) < kMinMatches) {
    return std::nullopt;
  }
  Eigen::VectorXd errors(static_cast<Eigen::Index>(matches.size()));
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    const PointMatch& match = matches[static_cast<std::size_t>(i)];
    errors[i] = match.left.y() - match.right.y();
  }
  const Eigen::VectorXd smooth = smooth_part(terms_of(matches), errors);
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    distances.push_back(std::abs(errors[i] - smooth[i]));
  }
  const double limit =
      std::max(kTolerance_px, kErrorDeviations * 1.4826 * upper_median(std::vector(distances)));

  VerticalError result{.matches = static_cast<int>(matches.size())};
  std::vector<double> absolute;
  std::vector<double> disparities;
  double sum = 0;
  double sum_of_squares = 0;
  double smooth_sum_of_squares = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (distances[i] > limit) {
      continue;
    }
    absolute.push_back(std::abs(errors[row]));
    disparities.push_back(matches[i].left.x() - matches[i].right.x());
    sum += errors[row];
    sum_of_squares += errors[row] * errors[row];
    smooth_sum_of_squares += smooth[row] * smooth[row];
  }
  result.inliers = static_cast<int>(absolute.size());
  if (result.inliers < kMinMatches) {
    return std::nullopt;
  }
  const double count = result.inliers;
  result.rms_px = std::sqrt(sum_of_squares / count);
  result.mean_px = sum / count;
  for (const double distance : absolute) {
    result.mean_absolute_px += distance / count;
  }
  result.percentile_95_px = percentile(absolute, 0.95);
  result.max_px = *std::max_element(absolute.begin(), absolute.end());
  result.systematic_px = std::sqrt(smooth_sum_of_squares / count);
  result.min_disparity_px = percentile(disparities, 0.01);
  result.max_disparity_px = percentile(disparities, 0.99);
  const auto is_negative = [](double disparity) { return disparity < kNegative_px; };
  result.negative_share =
      static_cast<double>(std::count_if(disparities.begin(), disparities.end(), is_negative)) /
      count;
  return result;
}

double more_bad_percent(double rows_off_px) {
  for (std::size_t i = 1; i < kMeasured.size(); ++i) {
    const auto [lower_px, lower] = kMeasured[i - 1];
    const auto [upper_px, upper] = kMeasured[i];
    if (rows_off_px <= upper_px) {
      return lower + (upper - lower) * (rows_off_px - lower_px) / (upper_px - lower_px);
    }
  }
  return kMeasured.back().second;
}

bool is_rectified(const VerticalError& error) {
  return more_bad_percent(error.systematic_px) <= kMaxMoreBad_percent;
}

}  // namespace vantage
