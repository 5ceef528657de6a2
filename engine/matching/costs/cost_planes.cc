#include "engine/matching/costs/cost_planes.h"

#include "engine/image/intensity_rows.h"
#include "kernels/row_resampling/row_resampling.h"

namespace vantage {
namespace {

/// Calls write(row) for the row of whole columns, then moves it to the columns of the phase.
template <typename Write>
void write_at_phase(const PlaneSource& source, float* intensities, const Write& write) {
  if (source.phase.is_whole() || source.is_at_phase) {
    write(intensities);
    return;
  }
  const int width = source.width();
  const auto work =
      source.execution.scratch().lease(sizeof(float) * static_cast<std::size_t>(width));
  auto* const whole = reinterpret_cast<float*>(work.data());
  write(whole);
  const float fraction =
      static_cast<float>(source.phase.index) / static_cast<float>(source.phase.count);
  kernels::resample_row(whole, width, fraction, intensities);
}

}  // namespace

PlaneMargins margins_of(const kernels::CandidateGeometry& geometry) {
  // Lane i of sample n is read at n + disparity_min + i in both the plain and the mirrored plane.
  // Kernels write whole vectors: up to a lane multiple past the last pixel used.
  return {std::max(kFilterMarginBefore, -geometry.disparity_min),
          std::max(kFilterMarginAfter,
                   geometry.disparity_min + geometry.lanes() + kernels::kLaneMultiple)};
}

void PlaneSource::luma_row(int y, float* intensities) const {
  write_at_phase(*this, intensities, [&](float* row) { intensity_row(photograph, y, row); });
}

void PlaneSource::channel_row(std::size_t channel, int y, float* intensities) const {
  if (channels == 1) {
    luma_row(y, intensities);
    return;
  }
  write_at_phase(*this, intensities, [&](float* row) {
    channel_intensity_row(photograph, static_cast<int>(channel), y, row);
  });
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
