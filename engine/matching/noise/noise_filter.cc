#include "engine/matching/noise/noise_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/image/intensity_rows.h"
#include "engine/image/memory_use.h"
#include "kernels/bilateral/bilateral.h"

namespace vantage {
namespace {

constexpr int kRadius = 3;
/// Rows that a task smooths.
constexpr int kTaskRows = 64;

/// Neighbours of pixels, one of each pair.
struct Neighbour {
  int u;
  int v;
  std::int16_t weight;
};
using Neighbours = std::vector<Neighbour>;

/// Those up to that many columns and rows away.
Neighbours neighbours(double sigma_px, int columns, int rows) {
  Neighbours result;
  for (int v = 0; v <= rows; ++v) {
    for (int u = v == 0 ? 1 : -columns; u <= columns; ++u) {
      const double weight = std::exp(-(u * u + v * v) / (2 * sigma_px * sigma_px));
      result.push_back({u, v, static_cast<std::int16_t>(kernels::kBilateralOne * weight)});
    }
  }
  return result;
}

/// Smooths row y. row_of(y): the first pixel of a row of steps.
template <typename RowOf>
void smooth_row(const Neighbours& neighbours, int y, const RowOf& row_of,
                kernels::BilateralRow row) {
  std::array<kernels::BilateralPair, (2 * kRadius + 1) * (2 * kRadius + 1) / 2> pairs;
  std::ranges::transform(neighbours, pairs.begin(), [&](const Neighbour& one) {
    return kernels::BilateralPair{row_of(y - one.v) - one.u, row_of(y + one.v) + one.u, one.weight};
  });
  row.pixels = row_of(y);
  row.pairs = {pairs.data(), neighbours.size()};
  kernels::bilateral_row(row);
}

/// Steps as values of 16-bit photographs, `channels` apart.
void to_values(const std::int16_t* steps, int width, int channels, std::uint16_t* values) {
  static_assert(kernels::kBilateralUnit == 128);  // 65535 / 255 is 257, 2 · 128 + 1
  static constexpr std::int16_t kBlack = 0;
  static constexpr std::int16_t kWhite = 255 * kernels::kBilateralUnit;
  const auto value = [](std::int16_t step) {
    const std::int16_t level = std::min(std::max(step, kBlack), kWhite);
    return static_cast<std::uint16_t>(2 * level + ((level + 64) >> 7));
  };
  if (channels == 1) {
    std::transform(steps, steps + width, values, value);
    return;
  }
  for (int x = 0; x < width; ++x) {
    values[x * channels] = value(steps[x]);
  }
}

}  // namespace

NoiseFilter filter_of(const FoundNoise& noise) {
  switch (noise.kind) {
    case NoiseKind::kNone:
      break;
    case NoiseKind::kCodec:
      return {.sigma_px = 1, .cut_off_grey_levels = 20, .is_separated = true};
    case NoiseKind::kSensor:
      return {.sigma_px = 2, .cut_off_grey_levels = 4 * noise.grey_levels};
  }
  return {};
}

const Photograph& SmoothedPhotograph::make(const Photograph& photograph, int channels,
                                           const NoiseFilter& filter, Execution& execution) {
  const int width = photograph.width();
  const int height = photograph.height();
  Image<std::uint16_t>& result = pixels_of<std::uint16_t>(result_);
  result.resize(width, height, channels);
  result_.left_out = Mask::borrowed(photograph.left_out.view());
  const double cut_off = std::clamp(filter.cut_off_grey_levels, kernels::kMinBilateralCutOff,
                                    kernels::kMaxBilateralCutOff);
  const kernels::BilateralRow row{
      .width = width, .cut_off = static_cast<int>(std::lround(kernels::kBilateralUnit * cut_off))};
  const Neighbours along = neighbours(filter.sigma_px, filter.is_separated ? kRadius : 0, 0);
  const Neighbours across = neighbours(filter.sigma_px, filter.is_separated ? 0 : kRadius, kRadius);
  // Rows of steps have kRadius columns before, and up to a vector after the image's.
  const int columns = row.width_in_whole_columns() + kernels::kBilateralColumns;
  execution.executor().parallel_for((height + kTaskRows - 1) / kTaskRows, [&](int task) {
    const int first_row = task * kTaskRows;
    const int end_row = std::min(first_row + kTaskRows, height);
    const int above = std::max(0, first_row - kRadius);
    const int below = std::min(height, end_row + kRadius);
    const auto values = static_cast<std::size_t>(columns);
    const auto rows = static_cast<std::size_t>(below - above);
    const auto work =
        execution.scratch().lease(values * (sizeof(float) + (rows + 1) * sizeof(std::int16_t)));
    auto* const grey = reinterpret_cast<float*>(work.data());
    auto* const steps = reinterpret_cast<std::int16_t*>(grey + columns) + kRadius;
    const auto row_of = [&](int y) {
      return steps + values * static_cast<std::size_t>(1 + std::clamp(y, above, below - 1) - above);
    };
    const auto repeat_borders = [&](std::int16_t* pixels) {
      std::fill_n(pixels - kRadius, kRadius, pixels[0]);
      std::fill(pixels + width, pixels - kRadius + columns, pixels[width - 1]);
    };
    for (int c = 0; c < channels; ++c) {
      kernels::BilateralRow smoothed = row;
      for (int y = above; y < below; ++y) {
        if (channels == 1) {
          intensity_row(photograph, y, grey);
        } else {
          channel_intensity_row(photograph, c, y, grey);
        }
        kernels::bilateral_steps_row(grey, width, steps);
        repeat_borders(steps);
        smoothed.output = row_of(y);
        smooth_row(
            along, y, [&](int) { return steps; }, smoothed);
        repeat_borders(smoothed.output);
      }
      smoothed.output = steps;
      for (int y = first_row; y < end_row; ++y) {
        smooth_row(across, y, row_of, smoothed);
        to_values(steps, width, channels, result.row(y) + c);
      }
    }
  });
  return result_;
}

std::size_t SmoothedPhotograph::held_bytes() const { return vantage::held_bytes(result_); }

}  // namespace vantage
