#include "engine/matching/costs/cost_planes.h"

#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

void changes_intensities(const IntensityChange& change, int width, float* levels) {
  if (change.is_none()) {
    return;
  }
  const auto gain = static_cast<float>(change.gain);
  const auto offset = static_cast<float>(change.offset);
  std::transform(levels, levels + width, levels,
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

void PlaneSource::luma_row(int y, float* levels) const {
  intensity_row(photograph, y, levels);
  changes_intensities(intensity_changes.luma, width(), levels);
}

void PlaneSource::level_row(std::size_t channel, int y, float* levels) const {
  if (channels == 1) {
    luma_row(y, levels);
    return;
  }
  channel_intensity_row(photograph, static_cast<int>(channel), y, levels);
  changes_intensities(intensity_changes.channels[channel], width(), levels);
}

void prepare_filter_levels(const PlaneSource& source, FilterLevels& levels) {
  source.for_each_channel([&](std::size_t c) {
    levels[c].resize(source.width(), source.height(), kFilterMarginBefore, kFilterMarginAfter);
  });
  source.for_each_channel_row([&](std::size_t c, int y) {
    source.level_row(c, y, levels[c].row(y));
    levels[c].fill_margins(y);
  });
}

}  // namespace vantage
