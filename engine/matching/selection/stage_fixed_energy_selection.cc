#include "engine/matching/selection/stage_fixed_energy_selection.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/column_work.h"
#include "kernels/cell_winner/cell_winner.h"
#include "kernels/energy_winner/energy_winner.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;
using scheduler::Range;

class EnergySelectionStage final : public scheduler::RowStage {
 public:
  EnergySelectionStage(const kernels::CandidateGeometry& geometry, Subpixel subpixel,
                       float steps_per_nat, const MapOutputs& outputs,
                       const CandidateBlocks* blocks)
      : RowStage({geometry.width, outputs.disparity_px.height()}),
        geometry_(geometry),
        is_refined_(subpixel == Subpixel::kParabola),
        steps_per_nat_(steps_per_nat),
        outputs_(outputs),
        blocks_(blocks),
        lanes_(blocks == nullptr ? geometry.lanes() : blocks->lanes()) {}

  [[nodiscard]] std::string_view name() const override { return "energy selection"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    kernels::KernelWork work = kernels::energy_winner_work() + kernels::kEnergyDisparityWork;
    if (wants_probability()) {
      work = work + kernels::kEnergyProbabilityWork;
    }
    if (!outputs_.energy.empty()) {
      work = work + kernels::kProbabilityEnergyWork;
    }
    return vantage::column_work(work, candidates_in(blocks_, geometry_.count));
  }

  void make_row(const scheduler::RowTask& task) const override {
    for (int x = task.columns.begin; x < task.columns.end;) {
      if (blocks_ == nullptr) {
        const Range columns{x, std::min(x + kMaxColumns, task.columns.end)};
        Part part{.columns = columns, .lanes = lanes_};
        select(task, part, {0, lanes_}, 0);
        write(task, part);
        x = columns.end;
        continue;
      }
      const CandidateBlocks::Run run = blocks_->run_at(x, task.y, task.columns.end);
      Part part{.columns = run.columns,
                .lanes = static_cast<int>(run.blocks.size()) * kernels::kLaneMultiple};
      const BlockSegments segments(run.blocks);
      int lane = 0;
      for (const int end : segments.ends()) {
        select(task, part, {lane, end}, candidate_of(run.blocks, lane));
        lane = end;
      }
      write(task, part);
      x = run.columns.end;
    }
  }

 private:
  static constexpr int kMaxColumns = CandidateBlocks::kMaxRunColumns;

  /// Some columns of a row, and their selection so far.
  struct Part {
    Range columns;
    int lanes = 0;  ///< number of lanes in use
    std::array<float, kMaxColumns> disparity_px = {};
    std::array<FixedEnergy, kMaxColumns> min = {};
  };

  [[nodiscard]] bool wants_probability() const {
    return !outputs_.confidence.empty() || !outputs_.energy.empty();
  }
  [[nodiscard]] const FixedEnergy* cells(const scheduler::RowTask& task, int x, int lane) const {
    return task.input.row<FixedEnergy>(task.y) +
           static_cast<std::ptrdiff_t>(x - task.input.columns().begin) * lanes_ + lane;
  }

  /// Selects among consecutive candidates in some lanes, the smallest ones first, and the previous
  /// selection.
  void select(const scheduler::RowTask& task, Part& part, Range lanes, int first_candidate) const {
    kernels::EnergyRow row;
    row.cells = cells(task, part.columns.begin, lanes.begin);
    row.pitch = lanes_;
    row.geometry = geometry_;
    row.geometry.disparity_min += first_candidate;
    row.geometry.count = std::min(lanes.size(), geometry_.count - first_candidate);
    row.first_column = part.columns.begin;
    row.columns = part.columns.size();
    std::array<std::int32_t, kMaxColumns> winners;
    const bool is_first = lanes.begin == 0;
    if (is_first) {
      kernels::select_energy_winners_row(row, winners.data(), part.min.data());
      kernels::energy_disparity_row(row, winners.data(), is_refined_, part.disparity_px.data());
      return;
    }
    std::array<FixedEnergy, kMaxColumns> min;
    std::array<float, kMaxColumns> disparity_px;
    kernels::select_energy_winners_row(row, winners.data(), min.data());
    kernels::energy_disparity_row(row, winners.data(), is_refined_, disparity_px.data());
    for (std::size_t j = 0; j < static_cast<std::size_t>(row.columns); ++j) {
      if (min[j] < part.min[j]) {
        part.min[j] = min[j];
        part.disparity_px[j] = disparity_px[j];
      }
    }
  }

  void write(const scheduler::RowTask& task, const Part& part) const {
    const int x = part.columns.begin;
    const int columns = part.columns.size();
    std::copy_n(part.disparity_px.data(), columns, outputs_.disparity_px.row(task.y) + x);
    if (!wants_probability()) {
      return;
    }
    std::array<float, kMaxColumns> probability;
    kernels::energy_probability_row(
        {.cells = cells(task, x, 0), .pitch = lanes_, .columns = columns, .lanes = part.lanes},
        part.min.data(), steps_per_nat_, probability.data());
    if (!outputs_.confidence.empty()) {
      std::copy_n(probability.data(), columns, outputs_.confidence.row(task.y) + x);
    }
    if (!outputs_.energy.empty()) {
      kernels::probability_energy_row(probability.data(), columns, outputs_.energy.row(task.y) + x);
    }
  }

  kernels::CandidateGeometry geometry_;
  bool is_refined_;
  float steps_per_nat_;
  MapOutputs outputs_;
  const CandidateBlocks* blocks_;
  int lanes_;  ///< of a column
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_fixed_energy_selection_stage(
    const kernels::CandidateGeometry& geometry, Subpixel subpixel, float steps_per_nat,
    const MapOutputs& outputs, const CandidateBlocks* blocks) {
  return std::make_unique<EnergySelectionStage>(geometry, subpixel, steps_per_nat, outputs, blocks);
}

}  // namespace vantage
