#include "engine/matching/aggregation/smoothing_kernels.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace vantage {
namespace {

/// Unnormalised weights from the centre of a symmetric kernel outwards; the smallest are added
/// first.
std::vector<float> normalised(const std::vector<double>& from_middle) {
  double sum = 0;
  for (std::size_t k = from_middle.size(); k-- > 1;) {
    sum += 2 * from_middle[k];
  }
  sum += from_middle[0];
  std::vector<float> weights;
  for (const double weight : from_middle) {
    weights.push_back(static_cast<float>(weight / sum));
  }
  return weights;
}

}  // namespace

std::vector<float> gaussian_kernel(double sigma_px) {
  std::vector<double> from_middle;
  for (int k = 0; k <= static_cast<int>(std::ceil(4 * sigma_px)); ++k) {
    from_middle.push_back(std::exp(-0.5 * k * k / (sigma_px * sigma_px)));
  }
  return normalised(from_middle);
}

std::array<int, 4> box_cascade_widths_px(double sigma_px) {
  // With w = 2r + 1 the variance is r(r + 1)/3 and the fourth cumulant −(w⁴ − 1)/120. No box needs
  // to be wider than the first whose own variance exceeds σ².
  const double wanted = 3 * sigma_px * sigma_px;
  const int max = static_cast<int>(std::sqrt(wanted)) + 1;
  const auto fourth_power = [](int radius) {
    const double width_squared = (2.0 * radius + 1) * (2.0 * radius + 1);
    return width_squared * width_squared;
  };
  std::array<int, 4> best = {};
  std::pair<double, double> best_distance = {std::numeric_limits<double>::max(), 0};
  for (int a = 0; a <= max; ++a) {
    for (int b = a; b <= max; ++b) {
      for (int c = b; c <= max; ++c) {
        for (int d = c; d <= max; ++d) {
          const int variances = a * (a + 1) + b * (b + 1) + c * (c + 1) + d * (d + 1);
          const std::pair<double, double> distance = {
              std::abs(variances - wanted),
              fourth_power(a) + fourth_power(b) + fourth_power(c) + fourth_power(d)};
          if (distance < best_distance) {
            best_distance = distance;
            best = {2 * a + 1, 2 * b + 1, 2 * c + 1, 2 * d + 1};
          }
        }
      }
    }
  }
  return best;
}

std::vector<float> box_cascade_kernel(const std::array<int, 4>& widths_px) {
  std::vector<double> kernel = {1};
  for (const int width : widths_px) {
    std::vector<double> wider(kernel.size() + static_cast<std::size_t>(width) - 1, 0);
    for (std::size_t i = 0; i < kernel.size(); ++i) {
      for (std::size_t j = 0; j < static_cast<std::size_t>(width); ++j) {
        wider[i + j] += kernel[i];
      }
    }
    kernel = std::move(wider);
  }
  return normalised(
      {kernel.begin() + static_cast<std::ptrdiff_t>(kernel.size() / 2), kernel.end()});
}

}  // namespace vantage
