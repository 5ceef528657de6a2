#include "kernels/surface_coverage/surface_coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::kernels {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Shift between a surface and its background, in pixels, from which nothing of the image's own
// transition between them remains.
constexpr double kShiftOfSyntheticPx = 2;

// Upper limit of each image's certainty: outlines of round objects differ between images.
constexpr double kMaxCertainty = 0.98;

// Weights of the pixels at −1, 0 and 1 for a position at `offset` = −½..½.
struct Weights {
  double at[3];

  Weights(double offset, double spline_share) {
    const double before = 0.5 - offset;
    const double after = 0.5 + offset;
    const double spline[3] = {0.5 * before * before, 0.75 - offset * offset, 0.5 * after * after};
    const double linear[3] = {std::max(-offset, 0.0), 1 - std::abs(offset), std::max(offset, 0.0)};
    for (int k = 0; k < 3; ++k) {
      at[k] = linear[k] + spline_share * (spline[k] - linear[k]);
    }
  }
};

}  // namespace

double surface_coverage(const CoverageSource& source, double u, double v, double nearness,
                        double background_nearness) {
  const ExactSource surface = exact_source(source.way_back, u, v, nearness);
  if (!surface.is_visible) {
    return kUnknown;
  }
  const ExactSource background = exact_source(source.way_back, u, v, background_nearness);
  const double shift_x = background.x - surface.x;
  const double shift_y = background.y - surface.y;
  const double spline_share =
      background.is_visible
          ? std::min(1.0, std::sqrt(shift_x * shift_x + shift_y * shift_y) / kShiftOfSyntheticPx)
          : 1.0;
  // Farther outside, all pixels equal those at the border.
  const double x = std::clamp(surface.x, -2.0, source.width + 1.0);
  const double y = std::clamp(surface.y, -2.0, source.height + 1.0);
  const double column = std::floor(x + 0.5);
  const double line = std::floor(y + 0.5);
  const Weights weight_x(x - column, spline_share);
  const Weights weight_y(y - line, spline_share);
  double covered = 0;
  for (int j = 0; j < 3; ++j) {
    const int row = std::clamp(static_cast<int>(line) + j - 1, 0, source.height - 1);
    const float* disparity_px = source.disparity_px + row * source.stride;
    double covered_in_row = 0;
    for (int i = 0; i < 3; ++i) {
      const int at = std::clamp(static_cast<int>(column) + i - 1, 0, source.width - 1);
      if (std::abs(double{disparity_px[at]} - surface.disparity_px) <=
          double{source.gradient_limit_px}) {
        covered_in_row += weight_x.at[i];
      }
    }
    covered += weight_y.at[j] * covered_in_row;
  }
  return std::min(covered, 1.0);
}

double joint_coverage(double alpha, double first, double second) {
  if (std::isnan(first) || std::isnan(second)) {
    return std::isnan(first) ? second : first;
  }
  const double mean = alpha * first + (1 - alpha) * second;
  const double a = std::clamp(first, 1 - kMaxCertainty, kMaxCertainty);
  const double b = std::clamp(second, 1 - kMaxCertainty, kMaxCertainty);
  const double together = a * b / (a * b + (1 - a) * (1 - b));
  return mean + 4 * alpha * (1 - alpha) * (together - mean);
}

}  // namespace vantage::kernels
