#include "engine/matching/costs/cost_planes.h"

#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

void change_intensities(const IntensityChange& change, int width, float* intensities) {
  if (change.is_none()) {
    return;
  }
  const auto gain = static_cast<float>(change.gain);
  const auto offset = static_cast<float>(change.offset);
  std::transform(intensities, intensities + width, intensities,
                 [&](float level) { return gain * level + offset; });
}

}  // namespace

PlaneMargins margins_of(const kernels::CandidateGeometry& geometry) {
  // Lane i of column x is read at x + disparity_min + i in both the plain and the mirrored plane.
  // Kernels write whole vectors: up to a lane multiple past the last pixel used.
  return {std::max(kFilterMarginBefore, -geometry.disparity_min),
          std::max(kFilterMarginAfter,
                   geometry.disparity_min + geometry.lanes() + kernels::kLaneMultiple)};
}

void PlaneSource::luma_row(int y, float* intensities) const {
  intensity_row(photograph, y, intensities);
  change_intensities(intensity_changes.luma, width(), intensities);
}

void PlaneSource::channel_row(std::size_t channel, int y, float* intensities) const {
  if (channels == 1) {
    luma_row(y, intensities);
    return;
  }
  channel_intensity_row(photograph, static_cast<int>(channel), y, intensities);
  change_intensities(intensity_changes.channels[channel], width(), intensities);
}

void prepare_filter_intensities(const PlaneSource& source, FilterIntensities& intensities) {
  source.for_each_channel([&](std::size_t c) {
    intensities[c].resize(source.width(), source.height(), kFilterMarginBefore, kFilterMarginAfter);
  });
  source.for_each_channel_row([&](std::size_t c, int y) {
    source.channel_row(c, y, intensities[c].row(y));
    intensities[c].fill_margins(y);
  });
}

}  // namespace vantage
