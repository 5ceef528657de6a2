#pragma once

#include <cstdint>
#include <optional>

#include "engine/image/image.h"

namespace vantage {

/// Selection of the pixels to evaluate.
struct DisparityEvaluationOptions {
  /// Has the size of the maps. Only pixels of value 255 count. Empty: all pixels.
  std::optional<ImageView<const std::uint8_t>> mask = std::nullopt;
  /// Rows and columns excluded at each side of the image, ≥ 0.
  int ignore_border_px = 0;
  bool may_be_empty = false;  ///< no pixel to evaluate is no error: the scores are then of none
};

/// Errors of a disparity map against the truth. The *evaluated* pixels are those with finite truth,
/// inside the mask and outside the ignored border; the *valid* ones are those of them with a finite
/// estimate.
struct DisparityScores {
  std::int64_t evaluated_pixels = 0;  ///< ≥ 1, unless may_be_empty
  std::int64_t valid_pixels = 0;
  double coverage_percent = 0;  ///< 100 · valid / evaluated

  // Percentage of the evaluated pixels whose error exceeds the threshold (strictly) or that have no
  // valid estimate: omitting a pixel never improves these.
  double bad_0_5_percent = 0;
  double bad_1_percent = 0;
  double bad_2_percent = 0;
  double bad_3_percent = 0;
  double bad_4_percent = 0;
  /// KITTI 2015: those with an error above 3 px and above 5 % of the truth.
  double d1_percent = 0;

  // Over the valid pixels only, in pixels; NaN when there is none.
  double average_px = 0;  ///< mean |error|
  double rms_px = 0;
  // Quantiles: smallest error that 50, 90, 95 and 99 % of the valid pixels do not exceed.
  double a50_px = 0;
  double a90_px = 0;
  double a95_px = 0;
  double a99_px = 0;
};

/// Compares `disparity` with `truth`, both one channel and of one size, NaN or ±inf = unknown.
/// Errors: Error when sizes differ or no pixel can be evaluated, UsageError for a negative border.
/// Thread rule: pure.
DisparityScores evaluate_disparity(ImageView<const float> disparity, ImageView<const float> truth,
                                   const DisparityEvaluationOptions& options = {});

}  // namespace vantage
