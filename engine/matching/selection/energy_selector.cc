#include "engine/matching/selection/energy_selector.h"

#include <algorithm>
#include <cstdint>

#include "kernels/cell_winner/cell_winner.h"
#include "kernels/energy_winner/energy_winner.h"

namespace vantage {

kernels::KernelWork EnergySelector::work() const {
  kernels::KernelWork work = kernels::energy_winner_work() + kernels::kEnergyDisparityWork;
  if (wants_probability()) {
    work = work + kernels::kEnergyProbabilityWork;
  }
  return work;
}

void EnergySelector::select(const kernels::CandidateGeometry& geometry, const Columns& columns,
                            Selected& selected) const {
  int lanes = geometry.lanes();
  if (columns.blocks.empty()) {
    select_segment(geometry, columns, {0, lanes}, 0, selected);
  } else {
    lanes = static_cast<int>(columns.blocks.size()) * kernels::kLaneMultiple;
    const BlockSegments segments(columns.blocks);
    int lane = 0;
    for (const int end : segments.ends()) {
      select_segment(geometry, columns, {lane, end}, candidate_of(columns.blocks, lane), selected);
      lane = end;
    }
  }
  if (wants_probability()) {
    kernels::energy_probability_row(
        {.cells = columns.cells, .pitch = columns.pitch, .columns = columns.count, .lanes = lanes},
        selected.min.data(), steps_per_nat_, selected.probability.data());
  }
}

/// Selects among consecutive candidates in some lanes, the smallest ones first, and the previous
/// selection.
void EnergySelector::select_segment(const kernels::CandidateGeometry& geometry,
                                    const Columns& columns, scheduler::Range lanes,
                                    int first_candidate, Selected& selected) const {
  kernels::EnergyRow row;
  row.cells = columns.cells + lanes.begin;
  row.pitch = columns.pitch;
  row.geometry = geometry;
  row.geometry.disparity_min += first_candidate;
  row.geometry.count = std::min(lanes.size(), geometry.count - first_candidate);
  row.first_column = columns.first;
  row.columns = columns.count;
  std::array<std::int32_t, kMaxColumns> winners;
  if (lanes.begin == 0) {
    kernels::select_energy_winners_row(row, winners.data(), selected.min.data());
    kernels::energy_disparity_row(row, winners.data(), is_refined_, selected.disparity_px.data());
    return;
  }
  std::array<FixedEnergy, kMaxColumns> min;
  std::array<float, kMaxColumns> disparity_px;
  kernels::select_energy_winners_row(row, winners.data(), min.data());
  kernels::energy_disparity_row(row, winners.data(), is_refined_, disparity_px.data());
  for (std::size_t j = 0; j < static_cast<std::size_t>(row.columns); ++j) {
    if (min[j] < selected.min[j]) {
      selected.min[j] = min[j];
      selected.disparity_px[j] = disparity_px[j];
    }
  }
}

void EnergySelector::write(const Selected& selected, int x, int y, int count) const {
  std::copy_n(selected.disparity_px.data(), count, outputs_.disparity_px.row(y) + x);
  if (!outputs_.confidence.empty()) {
    std::copy_n(selected.probability.data(), count, outputs_.confidence.row(y) + x);
  }
}

}  // namespace vantage
