#include "engine/evaluation/disparity_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/error.h"

namespace vantage {
namespace {

void require_equal_size(const char* what, int width, int height, ImageView<const float> truth) {
  if (width != truth.width() || height != truth.height()) {
    throw Error(fmt::format("{} is {}x{}, expected the truth's {}x{}", what, width, height,
                            truth.width(), truth.height()));
  }
}

// Absolute errors of the valid pixels, in scan order, and the number of pixels evaluated.
struct Errors {
  std::vector<double> valid;
  std::int64_t evaluated = 0;
  std::int64_t outliers = 0;  // of KITTI 2015, among the valid pixels
};

Errors collect_errors(ImageView<const float> disparity, ImageView<const float> truth,
                      const DisparityEvaluationOptions& options) {
  Errors errors;
  const int border = options.ignore_border_px;
  for (int y = border; y < truth.height() - border; ++y) {
    for (int x = border; x < truth.width() - border; ++x) {
      const double expected = truth.at(x, y);
      if (!std::isfinite(expected) || (options.mask && options.mask->at(x, y) != 255)) {
        continue;
      }
      ++errors.evaluated;
      const double estimate = disparity.at(x, y);
      if (std::isfinite(estimate)) {
        const double error = std::abs(estimate - expected);
        errors.valid.push_back(error);
        errors.outliers += error > 3 && error > 0.05 * std::abs(expected) ? 1 : 0;
      }
    }
  }
  return errors;
}

// The smallest of the sorted errors that `percent` of them do not exceed.
double quantile(const std::vector<double>& sorted, std::size_t percent) {
  const std::size_t rank = (sorted.size() * percent + 99) / 100;
  return sorted[rank - 1];
}

}  // namespace

DisparityScores evaluate_disparity(ImageView<const float> disparity, ImageView<const float> truth,
                                   const DisparityEvaluationOptions& options) {
  require_equal_size("the disparity map", disparity.width(), disparity.height(), truth);
  if (options.mask) {
    require_equal_size("the mask", options.mask->width(), options.mask->height(), truth);
  }
  if (options.ignore_border_px < 0) {
    throw UsageError(
        fmt::format("ignore-border is {}, expected at least 0", options.ignore_border_px));
  }
  Errors errors = collect_errors(disparity, truth, options);
  if (errors.evaluated == 0) {
    if (options.may_be_empty) {
      return {};
    }
    throw Error("no pixels to evaluate, expected finite truth inside the mask and the border");
  }

  DisparityScores scores;
  scores.evaluated_pixels = errors.evaluated;
  scores.valid_pixels = static_cast<std::int64_t>(errors.valid.size());
  const auto evaluated = static_cast<double>(errors.evaluated);
  const auto valid = static_cast<double>(errors.valid.size());
  scores.coverage_percent = 100 * valid / evaluated;

  const auto bad_percent = [&](double threshold_px) {
    const auto good = std::count_if(errors.valid.begin(), errors.valid.end(),
                                    [&](double error) { return error <= threshold_px; });
    return 100 * (evaluated - static_cast<double>(good)) / evaluated;
  };
  scores.bad_0_5_percent = bad_percent(0.5);
  scores.bad_1_percent = bad_percent(1);
  scores.bad_2_percent = bad_percent(2);
  scores.bad_3_percent = bad_percent(3);
  scores.bad_4_percent = bad_percent(4);
  scores.d1_percent = 100 * (evaluated - valid + static_cast<double>(errors.outliers)) / evaluated;

  if (errors.valid.empty()) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    scores.average_px = scores.rms_px = kUnknown;
    scores.a50_px = scores.a90_px = scores.a95_px = scores.a99_px = kUnknown;
    return scores;
  }
  double sum = 0;
  double square_sum = 0;
  for (const double error : errors.valid) {
    sum += error;
    square_sum += error * error;
  }
  scores.average_px = sum / valid;
  scores.rms_px = std::sqrt(square_sum / valid);
  std::sort(errors.valid.begin(), errors.valid.end());
  scores.a50_px = quantile(errors.valid, 50);
  scores.a90_px = quantile(errors.valid, 90);
  scores.a95_px = quantile(errors.valid, 95);
  scores.a99_px = quantile(errors.valid, 99);
  return scores;
}

}  // namespace vantage
