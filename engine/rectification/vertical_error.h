#pragma once

#include <optional>
#include <vector>

#include "engine/rectification/feature_matches.h"

namespace vantage {

/// How far the rows of a pair are from corresponding: y_left − y_right over points that both images
/// show, in pixels.
struct VerticalError {
  int matches = 0;     ///< that were found
  int inliers = 0;     ///< of them, those that the numbers below are of
  double rms_px = 0;   ///< of y_left − y_right
  double mean_px = 0;  ///< of y_left − y_right, with its sign
  double mean_absolute_px = 0;
  double percentile_95_px = 0;  ///< 95 % of |y_left − y_right| are at most this
  double largest_px = 0;
  /// RMS of what varies smoothly over the image and with disparity, which is the error of the
  /// rectification; the rest of `rms_px` is that of finding the points.
  double systematic_px = 0;
  /// What all but one per cent at each end of x_left − x_right lie between.
  double least_disparity_px = 0;
  double largest_disparity_px = 0;
  /// Of the inliers, the part whose disparity x_left − x_right is below −0.5 pixels. Of images that
  /// show infinity at 0, as rectified ones do that are not shifted, next to none.
  double negative_share = 0;

  /// True when nine of ten disparities are negative, as when the images are exchanged. Images that
  /// are shifted against each other, as films are to show things behind the screen, look the same.
  [[nodiscard]] bool looks_exchanged() const { return negative_share >= 0.9; }
};

/// Matches that a statement is made of.
inline constexpr int kLeastMatches = 20;

/// The error of these matches, of which fewer than half are wrong. Wrong are those that are off by
/// more than a pixel, and by more than 4 standard deviations, from a polynomial of second degree in
/// x and y and of first degree in disparity, fitted to all. None if fewer than kLeastMatches
/// are right. Thread rule: may be called concurrently.
std::optional<VerticalError> vertical_error(const std::vector<PointMatch>& matches);

/// The error of a pair of images of equal sizes. Throws Error when they have fewer than
/// kLeastMatches points in common.
VerticalError measure_vertical_error(const Photograph& left, const Photograph& right);

/// A quick look at the same, for pairs that ought to be rectified: a tenth of the time, images
/// with a side beyond 640 pixels reduced. None when there are too few matches to tell.
std::optional<VerticalError> check_rectification(const Photograph& left, const Photograph& right);

}  // namespace vantage
