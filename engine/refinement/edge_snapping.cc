#include "engine/refinement/edge_snapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/image/intensity_rows.h"
#include "engine/refinement/edge_tracing.h"
#include "kernels/edge_snapping/edge_snapping.h"

namespace vantage {
namespace {

constexpr int kLowThreshold = 6;    // grey levels per pixel
constexpr int kHighThreshold = 10;  // grey levels per pixel
// Units of a 16-bit gradient per grey level per pixel: 255/2 times this fits.
constexpr int kGradientSteps = 128;

constexpr int kRadius = 4;
using HalfKernel = std::array<float, kRadius + 1>;

/// Samples of the Gaussian of σ = 1 from the centre outwards, normalised to a sum of 1 over both
/// sides.
HalfKernel gaussian() {
  HalfKernel kernel{};
  double sum = 0;
  for (int i = -kRadius; i <= kRadius; ++i) {
    sum += std::exp(-0.5 * i * i);
  }
  for (int i = 0; i <= kRadius; ++i) {
    kernel[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-0.5 * i * i) / sum);
  }
  return kernel;
}

/// `grey` is a row with kRadius columns of margin on either side, which are replicated here.
void smooth_along_row(float* grey, const HalfKernel& kernel, int width, float* smooth) {
  std::fill(grey - kRadius, grey, grey[0]);
  std::fill(grey + width, grey + width + kRadius, grey[width - 1]);
  for (int x = 0; x < width; ++x) {
    float sum = kernel[0] * grey[x];
    for (int k = 1; k <= kRadius; ++k) {
      sum += kernel[static_cast<std::size_t>(k)] * (grey[x - k] + grey[x + k]);
    }
    smooth[x] = sum;
  }
}

void smooth_across_rows(const Image<float>& rows, int y, const HalfKernel& kernel, float* smooth) {
  const int width = rows.width();
  std::transform(rows.row(y), rows.row(y) + width, smooth,
                 [&](float value) { return kernel[0] * value; });
  for (int k = 1; k <= kRadius; ++k) {
    const float* above = rows.row(std::max(y - k, 0));
    const float* below = rows.row(std::min(y + k, rows.height() - 1));
    for (int x = 0; x < width; ++x) {
      smooth[x] += kernel[static_cast<std::size_t>(k)] * (above[x] + below[x]);
    }
  }
}

/// Half the difference of the neighbours, in gradient units.
std::int16_t central_difference(float before, float after) {
  constexpr int kMax = std::numeric_limits<std::int16_t>::max();
  const float steps = (after - before) * (kGradientSteps / 2.0F);
  const float limited = std::clamp(steps, -static_cast<float>(kMax), static_cast<float>(kMax));
  return static_cast<std::int16_t>(static_cast<int>(limited + (kMax + 0.5F)) - kMax);
}

}  // namespace

void find_edges(const Photograph& photograph, Execution& execution, EdgeSnappingWork& work) {
  const int width = photograph.width();
  const int height = photograph.height();
  const HalfKernel kernel = gaussian();
  work.grey.resize(width + 2 * kRadius, height);
  work.smooth_x.resize(width, height);
  work.gradient_x.resize(width, height);
  work.gradient_y.resize(width, height);
  work.edges.resize(width, height);
  execution.for_each_row(height, [&](int y) {
    float* grey = work.grey.row(y) + kRadius;
    intensity_row(photograph, y, grey);
    smooth_along_row(grey, kernel, width, work.smooth_x.row(y));
  });
  execution.for_each_row(
      height, [&](int y) { smooth_across_rows(work.smooth_x, y, kernel, work.grey.row(y)); });
  execution.for_each_row(height, [&](int y) {
    const float* row = work.grey.row(y);
    const float* above = work.grey.row(std::max(y - 1, 0));
    const float* below = work.grey.row(std::min(y + 1, height - 1));
    std::int16_t* gradient_x = work.gradient_x.row(y);
    std::int16_t* gradient_y = work.gradient_y.row(y);
    for (int x = 0; x < width; ++x) {
      gradient_x[x] = central_difference(row[std::max(x - 1, 0)], row[std::min(x + 1, width - 1)]);
      gradient_y[x] = central_difference(above[x], below[x]);
    }
  });
  trace_edges(work.gradient_x, work.gradient_y,
              {kLowThreshold * kGradientSteps, kHighThreshold * kGradientSteps}, execution,
              work.edges);
}

void snap_discontinuities(const Mask& edges, int max_px, Execution& execution,
                          DisparityMap& map_px) {
  execution.for_each_row(map_px.height(), [&](int y) {
    kernels::snap_discontinuities_row(edges.row(y), max_px, map_px.width(), map_px.row(y));
  });
}

}  // namespace vantage
