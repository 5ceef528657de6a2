#include "engine/matching/costs/image_gradient.h"

#include <algorithm>
#include <cmath>

#include "kernels/gradient/gradient.h"

namespace vantage {
namespace {

using kernels::FilterTaps;

/// A derivative along one axis and the smoothing across it.
struct DerivativeFilter {
  FilterTaps derivative{};
  FilterTaps across{};
};

constexpr DerivativeFilter kCentral{{0, -1, 0, 1, 0}, {0, 0, 1, 0, 0}};
constexpr DerivativeFilter kForward{{0, 0, -1, 1, 0}, {0, 0, 1, 0, 0}};
constexpr DerivativeFilter kSobel{{0, -1, 0, 1, 0}, {0, 1, 2, 1, 0}};
constexpr DerivativeFilter kSimoncelli3{{0, -0.4553F, 0, 0.4553F, 0},
                                        {0, 0.2242F, 0.5516F, 0.2242F, 0}};
constexpr DerivativeFilter kSimoncelli5{{-0.1077F, -0.2827F, 0, 0.2827F, 0.1077F},
                                        {0.0357F, 0.2489F, 0.4308F, 0.2489F, 0.0357F}};

const DerivativeFilter& filter_of(GradientFilter filter) {
  switch (filter) {
    case GradientFilter::kForward:
      return kForward;
    case GradientFilter::kSobel:
      return kSobel;
    case GradientFilter::kSimoncelli3:
      return kSimoncelli3;
    case GradientFilter::kSimoncelli5:
      return kSimoncelli5;
    case GradientFilter::kCentral:
      break;
  }
  return kCentral;
}

FilterTaps gaussian_taps() {
  constexpr double kSigma = 0.5;
  double weights[5];
  double sum = 0;
  for (int k = -2; k <= 2; ++k) {
    weights[k + 2] = std::exp(-k * k / (2 * kSigma * kSigma));
    sum += weights[k + 2];
  }
  FilterTaps taps;
  std::transform(std::begin(weights), std::end(weights), taps.begin(),
                 [&](double weight) { return static_cast<float>(weight / sum); });
  return taps;
}

/// Rows y − 2 … y + 2, the border replicated.
kernels::SeparableFilter rows_around(const FilterSource& image, int y) {
  kernels::SeparableFilter filter;
  filter.width = image.width;
  for (int v = -kernels::kFilterRadius; v <= kernels::kFilterRadius; ++v) {
    filter.rows[static_cast<std::size_t>(v + kernels::kFilterRadius)] =
        image.intensities.row(std::clamp(y + v, 0, image.height - 1));
  }
  return filter;
}

}  // namespace

std::size_t filter_work_floats(int width) {
  return static_cast<std::size_t>(width) + 3 * kernels::kLaneMultiple;
}

void smooth_intensities(const FilterSource& image, Execution& execution,
                        IntensityPlane<float>& smooth) {
  const FilterTaps taps = gaussian_taps();
  execution.for_each_band(image.height, [&](int first_row, int end_row) {
    const auto work = execution.scratch().lease(sizeof(float) * filter_work_floats(image.width));
    for (int y = first_row; y < end_row; ++y) {
      kernels::SeparableFilter filter = rows_around(image, y);
      filter.down = taps;
      filter.along = taps;
      kernels::separable_filter_row(filter, reinterpret_cast<float*>(work.data()), smooth.row(y));
      smooth.fill_margins(y);
    }
  });
}

void gradient_row(const FilterSource& image, int y, GradientFilter filter, float* work, float* gx,
                  float* gy) {
  const auto& [derivative, across] = filter_of(filter);
  kernels::SeparableFilter row = rows_around(image, y);
  row.down = across;
  row.along = derivative;
  kernels::separable_filter_row(row, work, gx);
  row.down = derivative;
  row.along = across;
  kernels::separable_filter_row(row, work, gy);
}

}  // namespace vantage
