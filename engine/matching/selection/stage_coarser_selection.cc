#include "engine/matching/selection/stage_coarser_selection.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/column_work.h"
#include "engine/matching/levels/level_extents.h"
#include "kernels/fixed_energies/fixed_energies.h"
#include "kernels/max_product_step/max_product_step.h"

namespace vantage {
namespace {

using kernels::FixedEnergy;
using kernels::kLaneMultiple;
using scheduler::Range;
using Selected = EnergySelector::Selected;

class CoarserSelectionStage final : public scheduler::RowStage {
 public:
  CoarserSelectionStage(const kernels::CandidateGeometry& geometry, int height,
                        const EnergySelector& selector, const EnergyFormat& format,
                        const CoarserResult& coarser, const CandidateBlocks* blocks)
      : RowStage(coarser_extent({geometry.width, height})),
        geometry_(geometry),
        height_(height),
        selector_(selector),
        columns_(coarser, geometry.lanes()),
        byte_steps_(format.of_result()),
        blocks_(blocks),
        lanes_(blocks == nullptr ? geometry.lanes() : blocks->lanes()) {}

  [[nodiscard]] std::string_view name() const override { return "energy selection"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  /// Of some coarser columns: bytes, energies, energies above their minimum; these repeated.
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/,
                                        scheduler::Extent /*input*/) const override {
    return static_cast<std::size_t>(lanes_) * kCoarserColumns *
               (sizeof(std::uint8_t) + 4 * sizeof(FixedEnergy)) +
           sizeof(FixedEnergy) * work_cells();
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::kFixedEnergiesOfBytesWork + selector_.work(),
                                candidates_in(blocks_, geometry_.count));
  }

  void make_row(const scheduler::RowTask& task) const override {
    const Range fine{2 * task.columns.begin, std::min(2 * task.columns.end, geometry_.width)};
    for (int x = fine.begin; x < fine.end;) {
      CandidateBlocks::Run run{{x, std::min(x + EnergySelector::kMaxColumns, fine.end)}, {}};
      if (blocks_ != nullptr) {
        run = blocks_->run_at(x, 2 * task.y, fine.end);
      }
      if (run.is_wanted) {
        make_columns(task, run);
      }
      x = run.columns.end;
    }
  }

 private:
  static constexpr int kCoarserColumns = EnergySelector::kMaxColumns / 2;

  [[nodiscard]] std::size_t work_cells() const {
    return static_cast<std::size_t>(kernels::max_product_work_cells(lanes_, 0));
  }

  /// `run` starts at an even column.
  void make_columns(const scheduler::RowTask& task, const CandidateBlocks::Run& run) const {
    const Range coarse{run.columns.begin / 2, (run.columns.end + 1) / 2};
    const BlockList blocks = blocks_ == nullptr ? columns_.all_blocks() : run.blocks;
    const int lanes = static_cast<int>(blocks.size()) * kLaneMultiple;
    auto* const energies = reinterpret_cast<FixedEnergy*>(task.state);
    FixedEnergy* const above_min = energies + kCoarserColumns * lanes_;
    FixedEnergy* const work = above_min + 3 * kCoarserColumns * lanes_;
    auto* const bytes = reinterpret_cast<std::uint8_t*>(work + work_cells());
    columns_.fetch(task.y, blocks, coarse, bytes);
    kernels::fixed_energies_of_bytes_row(
        {.cells = bytes,
         .columns = coarse.size(),
         .lanes = lanes,
         .count = blocks_ == nullptr ? geometry_.count : blocks_->count(blocks)},
        byte_steps_, energies);
    kernels::MaxProductRow row;
    row.star.centre = row.star.up = row.star.down = row.star.source = energies;
    row.star.left_of_first = row.star.right_of_last = energies;
    row.star.columns = coarse.size();
    row.star.lanes = lanes;
    row.smooths = false;
    row.output = above_min;
    row.source_pitch = row.output_pitch = lanes;
    row.work = work;
    kernels::max_product_start_row(row);

    Selected selected;
    const kernels::CandidateRange plain = geometry_.columns_with_all_partners();
    if (plain.begin <= run.columns.begin && run.columns.end <= plain.end) {
      select_blocks_of_4(above_min, lanes, run, coarse.size(), selected);
    } else {
      select_pixels(above_min, lanes, run, selected);
    }
    for (int y = 2 * task.y; y < std::min(2 * task.y + 2, height_); ++y) {
      selector_.write(selected, run.columns.begin, y, run.columns.size());
    }
  }

  /// Of columns whose candidates all have partners.
  void select_blocks_of_4(const FixedEnergy* cells, int lanes, const CandidateBlocks::Run& run,
                          int coarser_columns, Selected& selected) const {
    // The selector tells partners from where columns lie: in the middle of an image wide enough,
    // all candidates have one.
    kernels::CandidateGeometry wide = geometry_;
    const int middle = geometry_.count + std::abs(geometry_.disparity_min) + coarser_columns;
    wide.width = 2 * middle;
    wide.near_ratio = 1;
    wide.opposite_ratio = 0;
    Selected of_blocks;
    selector_.select(wide,
                     {.cells = cells,
                      .pitch = lanes,
                      .first = middle - coarser_columns,
                      .count = coarser_columns,
                      .blocks = run.blocks},
                     of_blocks);
    for (std::size_t j = 0; j < static_cast<std::size_t>(run.columns.size()); ++j) {
      selected.disparity_px[j] = of_blocks.disparity_px[j / 2];
      selected.probability[j] = of_blocks.probability[j / 2];
    }
  }

  /// `cells` are followed by room for twice as many.
  void select_pixels(FixedEnergy* cells, int lanes, const CandidateBlocks::Run& run,
                     Selected& selected) const {
    FixedEnergy* const repeated = cells + kCoarserColumns * lanes_;
    for (int j = 0; j < run.columns.size(); ++j) {
      std::copy_n(cells + j / 2 * lanes, lanes, repeated + j * lanes);
    }
    selector_.select(geometry_,
                     {.cells = repeated,
                      .pitch = lanes,
                      .first = run.columns.begin,
                      .count = run.columns.size(),
                      .blocks = run.blocks},
                     selected);
  }

  kernels::CandidateGeometry geometry_;
  int height_;
  EnergySelector selector_;
  CoarserColumns columns_;
  kernels::ByteSteps byte_steps_;
  const CandidateBlocks* blocks_;
  int lanes_;  ///< of a column
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_coarser_selection_stage(
    const kernels::CandidateGeometry& geometry, int height, const EnergySelector& selector,
    const EnergyFormat& format, const CoarserResult& coarser, const CandidateBlocks* blocks) {
  return std::make_unique<CoarserSelectionStage>(geometry, height, selector, format, coarser,
                                                 blocks);
}

}  // namespace vantage
