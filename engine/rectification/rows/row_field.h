#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "engine/rectification/feature_matches.h"

namespace vantage {

/// How the rows of a pair differ: what `left` shows in row y, `right` shows in row y + v(x, y),
/// where x is the column in `right`. A polynomial of as many terms as the points carry.
class RowField {
 public:
  /// 1; x, y; xy, y² (with these, a homography of small angles); y (x² + y²) (a radial distortion).
  /// x and y are measured from the centre, in halves of the width.
  static constexpr int kMaxTerms = 6;
  using Terms = std::array<double, kMaxTerms>;

  RowField() = default;
  RowField(int width_px, int height_px, const Terms& coefficients_px)
      : width_(width_px), height_(height_px), coefficients_(coefficients_px) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const Terms& coefficients_px() const { return coefficients_; }

  /// v at a position, in pixels. Positive where the right image is lower.
  [[nodiscard]] double at(double x, double y) const { return along_row(y).at(x); }
  /// v along a row is a polynomial of second degree.
  struct Row {
    double centre_x = 0;
    std::array<double, 3> coefficients_px = {};

    [[nodiscard]] double at(double x) const {
      const double u = x - centre_x;
      return coefficients_px[0] + u * (coefficients_px[1] + u * coefficients_px[2]);
    }
  };
  [[nodiscard]] Row along_row(double y) const;
  /// The row of `left` that row y of `right` corresponds to: y' with y' + v(x, y') = y.
  [[nodiscard]] double row_of_left(double x, double y) const;
  /// Largest |v| in the image, and its root mean square.
  [[nodiscard]] double max_px() const;
  [[nodiscard]] double rms_px() const;
  /// v at the centre.
  [[nodiscard]] double offset_px() const { return coefficients_[0]; }
  /// Rotation of the right image there, clockwise.
  [[nodiscard]] double turn_degrees() const;

  friend bool operator==(const RowField&, const RowField&) = default;

  [[nodiscard]] static Terms terms_at(double x, double y, int width_px, int height_px);

 private:
  /// v at positions that cover the image.
  [[nodiscard]] Eigen::ArrayXd on_grid() const;

  int width_ = 0;
  int height_ = 0;
  Terms coefficients_ = {};
};

/// What the points of a pair say about its rows.
struct RowEstimate {
  RowField field;
  int terms = 0;            ///< 1, 3, 5 or 6 that are not 0
  int points = 0;           ///< found
  int inliers = 0;          ///< of these, what `field` explains
  double residual_px = 0;   ///< robust standard deviation of the inliers
  double deviation_px = 0;  ///< largest standard deviation of v in the image

  /// Whether resampling the right image gains more than it blurs: v is above kMinCorrection_px
  /// (RMS), and certain.
  [[nodiscard]] bool pays() const;
};

/// Rows that are off by less are left as they are. Of rectified pairs of data sets, venus (RMS 0.12
/// px) and cloth1 (0.07) have the same bad pixels with and without a correction, bull (0.14) 0.1
/// points more with it, motorcycle (0.25) 1.1 points less.
inline constexpr double kMinCorrection_px = 0.16;
/// Beyond, a pair is not nearly rectified.
inline constexpr double kMaxCorrection_px = 6;
/// Fewer points say nothing.
inline constexpr int kMinRowPoints = 30;

/// The smooth field that most of the points agree on: weights decrease with the distance from the
/// fit, whose scale goes from pixels down to that of the points. Terms are added in groups, only if
/// they are significant (F-test) and the points are spread so that v is certain in all the image.
/// None if fewer than kMinRowPoints or fewer than half of the points agree, or if v exceeds
/// kMaxCorrection_px. Thread rule: pure.
std::optional<RowEstimate> fit_rows(const std::vector<PointMatch>& points, int width_px,
                                    int height_px);

}  // namespace vantage
