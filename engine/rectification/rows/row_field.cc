#include "engine/rectification/rows/row_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "engine/order_statistics.h"

namespace vantage {
namespace {

constexpr double kMinScale_px = 0.1;
/// A point farther from the field, in standard deviations, is wrong.
constexpr double kInlierDeviations = 3;
/// Of the F-test of one or two terms, far beyond chance, because errors of neighbours are alike.
constexpr double kMinF = 12;
constexpr double kMaxDeviation_px = 0.1;
/// Points that agree no better do not know their row.
constexpr double kMaxResidual_px = 0.5;
/// Terms that change less are not worth having.
constexpr double kMinChange_px = 0.06;
constexpr int kGridSide = 9;

/// A fit of the first terms.
struct RowFit {
  Eigen::VectorXd coefficients;
  double scale_px = 0;
  double loss = 0;  ///< of all points, with another scale to compare
  double deviation_px = 0;
};

using RowTerms = Eigen::Matrix<double, Eigen::Dynamic, RowField::kMaxTerms>;

/// Terms at positions that cover the image.
RowTerms grid_terms(int width, int height) {
  RowTerms grid(kGridSide * kGridSide, RowField::kMaxTerms);
  for (int i = 0; i < kGridSide * kGridSide; ++i) {
    const auto terms =
        RowField::terms_at((width - 1.0) * (i % kGridSide) / (kGridSide - 1),
                           (height - 1.0) * (i / kGridSide) / (kGridSide - 1), width, height);
    grid.row(i) = Eigen::Map<const Eigen::RowVectorXd>(terms.data(), RowField::kMaxTerms);
  }
  return grid;
}

/// Geman and McClure's loss and weights: points far from the fit count as a constant.
double loss_of(const Eigen::ArrayXd& residuals, double scale) {
  const Eigen::ArrayXd squares = residuals.square();
  const double cut = 4 * scale * scale;
  return (squares * cut / (squares + cut)).sum();
}
Eigen::ArrayXd weights_of(const Eigen::ArrayXd& residuals, double scale) {
  return (1 + residuals.square() / (4 * scale * scale)).square().inverse();
}

double robust_scale(const Eigen::ArrayXd& residuals) {
  const Eigen::ArrayXd distances = residuals.abs();
  // The median of those that are not wrong by pixels.
  std::vector<double> near;
  std::copy_if(distances.begin(), distances.end(), std::back_inserter(near),
               [](double distance) { return distance < 1.5; });
  return near.empty() ? 1 : std::max(kMinScale_px, 1.4826 * upper_median(near));
}

RowFit fit_terms(const RowTerms& all, const Eigen::ArrayXd& offsets, int count,
                 const RowTerms& grid, std::span<const double> scales) {
  const auto terms = all.leftCols(count);
  Eigen::ArrayXd residuals = offsets;
  RowFit fit{.coefficients = Eigen::VectorXd::Zero(count)};
  Eigen::MatrixXd normal;
  const auto solve = [&](double scale) {
    const Eigen::ArrayXd weights = weights_of(residuals, scale);
    normal = terms.transpose() * weights.matrix().asDiagonal() * terms +
             1e-9 * weights.sum() * Eigen::MatrixXd::Identity(count, count);
    fit.coefficients = normal.ldlt().solve(terms.transpose() * (weights * offsets).matrix());
    residuals = offsets - (terms * fit.coefficients).array();
  };
  for (const double scale : scales) {
    solve(scale);
  }
  for (int round = 0; round < 4; ++round) {
    fit.scale_px = robust_scale(residuals);
    solve(fit.scale_px);
  }
  const auto on_grid = grid.leftCols(count);
  const Eigen::MatrixXd spread = normal.ldlt().solve(on_grid.transpose());
  fit.deviation_px =
      fit.scale_px *
      std::sqrt((on_grid.transpose().cwiseProduct(spread)).colwise().sum().maxCoeff());
  return fit;
}

/// Whether the terms that `larger` adds are significant, certain and large enough to matter.
bool is_better(const RowFit& larger, const RowFit& smaller, const RowTerms& all,
               const Eigen::ArrayXd& offsets, const RowTerms& grid) {
  const Eigen::Index more = larger.coefficients.size();
  const Eigen::Index fewer = smaller.coefficients.size();
  const auto residuals = [&](const RowFit& fit) -> Eigen::ArrayXd {
    return offsets - (all.leftCols(fit.coefficients.size()) * fit.coefficients).array();
  };
  const double scale = larger.scale_px;
  const double gain = loss_of(residuals(smaller), scale) - loss_of(residuals(larger), scale);
  const double f = gain / (static_cast<double>(more - fewer) * scale * scale);
  const double change =
      (grid.leftCols(more) * larger.coefficients - grid.leftCols(fewer) * smaller.coefficients)
          .cwiseAbs()
          .maxCoeff();
  return f >= kMinF && larger.deviation_px <= kMaxDeviation_px &&
         change >= std::max(kMinChange_px, 2 * larger.deviation_px);
}

}  // namespace

RowField::Terms RowField::terms_at(double x, double y, int width_px, int height_px) {
  const double half = width_px / 2.0;
  const double u = (x - (width_px - 1) / 2.0) / half;
  const double v = (y - (height_px - 1) / 2.0) / half;
  return {1, u, v, u * v, v * v, v * (u * u + v * v)};
}

RowField::Row RowField::along_row(double y) const {
  const double half = width_ / 2.0;
  const double v = (y - (height_ - 1) / 2.0) / half;
  const auto& [one, u, down, both, down2, radial] = coefficients_;
  return {.centre_x = (width_ - 1) / 2.0,
          .coefficients_px = {one + v * (down + v * (down2 + v * radial)), (u + v * both) / half,
                              v * radial / (half * half)}};
}

double RowField::row_of_left(double x, double y) const {
  // Slopes are hundredths: each round gains two digits.
  double row = y;
  for (int round = 0; round < 3; ++round) {
    row = y - at(x, row);
  }
  return row;
}

Eigen::ArrayXd RowField::on_grid() const {
  return grid_terms(width_, height_) *
         Eigen::Map<const Eigen::VectorXd>(coefficients_.data(), kMaxTerms);
}

double RowField::max_px() const { return on_grid().abs().maxCoeff(); }

double RowField::rms_px() const { return std::sqrt(on_grid().square().mean()); }

double RowField::turn_degrees() const {
  return std::atan(coefficients_[1] / (width_ / 2.0)) * 180 / std::numbers::pi;
}

bool RowEstimate::pays() const {
  return field.rms_px() >= kMinCorrection_px && field.max_px() >= 3 * deviation_px;
}

std::optional<RowEstimate> fit_rows(const std::vector<PointMatch>& points, int width_px,
                                    int height_px) {
  constexpr std::array<double, 6> kScales = {2, 2, 1.4, 1, 0.7, 0.5};
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < kMinRowPoints) {
    return std::nullopt;
  }
  RowTerms terms(count, RowField::kMaxTerms);
  Eigen::ArrayXd offsets(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PointMatch& point = points[static_cast<std::size_t>(i)];
    const auto at = RowField::terms_at(point.right.x(), point.left.y(), width_px, height_px);
    terms.row(i) = Eigen::Map<const Eigen::RowVectorXd>(at.data(), RowField::kMaxTerms);
    offsets[i] = point.right.y() - point.left.y();
  }
  const RowTerms grid = grid_terms(width_px, height_px);
  RowFit best = fit_terms(terms, offsets, 1, grid, kScales);
  for (const int more : {3, 5, 6}) {
    const RowFit larger = fit_terms(terms, offsets, more, grid, kScales);
    if (is_better(larger, best, terms, offsets, grid)) {
      best = larger;
    }
  }
  RowEstimate result{.field = {},
                     .terms = static_cast<int>(best.coefficients.size()),
                     .points = static_cast<int>(count),
                     .inliers = 0,
                     .residual_px = best.scale_px,
                     .deviation_px = best.deviation_px};
  const Eigen::ArrayXd distances =
      (offsets - (terms.leftCols(result.terms) * best.coefficients).array()).abs();
  result.inliers = static_cast<int>((distances <= kInlierDeviations * best.scale_px).count());
  RowField::Terms coefficients = {};
  std::copy(best.coefficients.begin(), best.coefficients.end(), coefficients.begin());
  result.field = RowField(width_px, height_px, coefficients);
  if (result.inliers < kMinRowPoints || 2 * result.inliers < result.points ||
      result.residual_px > kMaxResidual_px || result.field.max_px() > kMaxCorrection_px) {
    return std::nullopt;
  }
  return result;
}

}  // namespace vantage
