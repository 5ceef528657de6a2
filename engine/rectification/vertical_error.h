#pragma once

#include <optional>
#include <vector>

#include "engine/rectification/feature_matches.h"

namespace vantage {

/// Row misalignment of a pair: y_left − y_right over points found in both images, in pixels.
struct VerticalError {
  int matches = 0;     ///< number found
  int inliers = 0;     ///< number of these that the values below refer to
  double rms_px = 0;   ///< of y_left − y_right
  double mean_px = 0;  ///< of y_left − y_right, signed
  double mean_absolute_px = 0;
  double percentile_95_px = 0;  ///< 95 % of |y_left − y_right| are at most this
  double max_px = 0;
  /// RMS of the part that varies smoothly over the image and with disparity: the error of the
  /// rectification. The rest of `rms_px` is measurement error of the points.
  double systematic_px = 0;
  /// Range of x_left − x_right without one per cent at each end.
  double min_disparity_px = 0;
  double max_disparity_px = 0;
  /// Share of inliers whose disparity x_left − x_right is below −0.5 pixels. Almost 0 if infinity
  /// is at disparity 0, as in rectified images that are not shifted.
  double negative_share = 0;

  /// True if nine of ten disparities are negative, as when the images are exchanged. Images shifted
  /// against each other, as in films that show things behind the screen, look the same.
  [[nodiscard]] bool looks_exchanged() const { return negative_share >= 0.9; }
};

/// Minimum number of matches for a result.
inline constexpr int kMinMatches = 20;

/// The error of these matches, fewer than half of which are wrong. Outliers are more than a pixel
/// and more than 4 standard deviations from a polynomial of second degree in x and y and first
/// degree in disparity, fitted to all. None if fewer than kMinMatches inliers remain. Thread
/// rule: may be called concurrently.
std::optional<VerticalError> vertical_error(const std::vector<PointMatch>& matches);

// What it costs that rows do not correspond. Thread rule: pure.

/// The additional percentage of pixels that are wrong by more than a pixel with this row error,
/// interpolated from measurements (see the .cc file).
double more_bad_percent(double rows_off_px);
/// The percentage above which a warning is printed.
inline constexpr double kMaxMoreBad_percent = 5;

/// Whether the row error is too small to matter for matching.
bool is_rectified(const VerticalError& error);

}  // namespace vantage
